#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// Constants that the robot's mass and size contradict, with the number, its bound, its key and the likely
/// slip of the unit: a yaw inertia, limits of the yaw motion, a battery, a standby power.
[[nodiscard]] std::vector<std::string> implausible_constants(const Robot& robot);

}  // namespace joulepath
