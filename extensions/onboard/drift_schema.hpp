#pragma once

#include "scenarios/schema.hpp"

namespace joulepath {

/// Of the result of `drift --json`.
[[nodiscard]] Schema drift_schema();

}  // namespace joulepath
