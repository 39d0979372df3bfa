#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Doubts about poses that no repair of a column settles: a pose that repeats the noise of the wheels is
/// their odometry. It agrees with them whatever the robot does, so it shows neither slip nor a wrong radius
/// or track.
[[nodiscard]] std::vector<std::string> pose_notes(const Dataset& dataset);

}  // namespace joulepath
