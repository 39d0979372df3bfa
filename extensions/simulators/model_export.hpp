#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// A robot as a model of another simulator, and what that model cannot hold.
struct ModelExport {
  std::string text{};
  std::vector<std::string> lost{};
};

/// A chassis with its payload, two driven wheels and two casters without friction. `format`: mjcf, sdf or
/// urdf. The origin is the middle of the axle. The actuators of MJCF are the motors: a control is a voltage.
[[nodiscard]] ModelExport model_export(const Robot& robot, double payload_kg, const std::string& format);

}  // namespace joulepath
