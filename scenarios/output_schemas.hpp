#pragma once

#include "scenarios/schema.hpp"

namespace joulepath {

/// What the program writes. Results may hold more keys than these in later versions.
[[nodiscard]] Schema plan_schema();
[[nodiscard]] Schema diagnosis_schema();

}  // namespace joulepath
