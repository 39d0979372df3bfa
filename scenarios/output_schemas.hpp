#pragma once

#include "scenarios/schema.hpp"

namespace joulepath {

/// Schemas of the program's outputs. Results may have further keys in later versions.
[[nodiscard]] Schema plan_schema();
[[nodiscard]] Schema diagnosis_schema();
[[nodiscard]] Schema sweep_schema();
[[nodiscard]] Schema shard_schema();
[[nodiscard]] Schema controller_schema();
[[nodiscard]] Schema edges_schema();
[[nodiscard]] Schema loss_schema();
[[nodiscard]] Schema drift_schema();

}  // namespace joulepath
