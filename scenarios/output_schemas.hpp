#pragma once

#include "scenarios/schema.hpp"

namespace joulepath {

/// What the program writes. Results may hold more keys than these in later versions.
[[nodiscard]] Schema plan_schema();
[[nodiscard]] Schema diagnosis_schema();
[[nodiscard]] Schema sweep_schema();
[[nodiscard]] Schema shard_schema();
[[nodiscard]] Schema controller_schema();
[[nodiscard]] Schema edges_schema();
[[nodiscard]] Schema loss_schema();

}  // namespace joulepath
