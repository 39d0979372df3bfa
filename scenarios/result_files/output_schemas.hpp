#pragma once

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// Schemas of the program's outputs. Results may have further keys in later versions.
[[nodiscard]] Schema plan_schema();
[[nodiscard]] Schema diagnosis_schema();
[[nodiscard]] Schema after_schema();
[[nodiscard]] Schema edges_schema();
[[nodiscard]] Schema loss_schema();
[[nodiscard]] std::vector<Schema::Key> loss_keys();  ///< without schema and name

}  // namespace joulepath
