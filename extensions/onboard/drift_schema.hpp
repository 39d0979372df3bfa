#pragma once

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// Of the result of `drift --json`.
[[nodiscard]] Schema drift_schema();

}  // namespace joulepath
