#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Doubts about motor channels that no repair of a column settles: currents without their sign, motors
/// logged by another clock than their wheels.
[[nodiscard]] std::vector<std::string> motor_notes(const Dataset& dataset);

}  // namespace joulepath
