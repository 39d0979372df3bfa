#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/controller/leg_settings.hpp"

namespace joulepath {

/// Speeds and accelerations of a Nav2 or ros2_control parameter file: the least value of all nodes.
struct ControllerFile {
  std::optional<double> speed_m_s{}, acceleration_m_s2{}, deceleration_m_s2{};
  std::optional<double> yaw_rate_rad_s{}, turn_rate_rad_s{};  ///< in all motion; in turns in place
  std::optional<double> yaw_acceleration_rad_s2{}, yaw_deceleration_rad_s2{};
  std::vector<std::string> read{};  ///< the keys that were used, in the file's order
};

/// Reads velocity_smoother, controller_server (RPP, MPPI, DWB) and diff_drive_controller, under any node name
/// or namespace. Throws ConfigError for a file that is not YAML or has no such parameter.
[[nodiscard]] ControllerFile read_controller_settings(const std::string& file);

/// Drives a plan with these settings; a setting that the file lacks is the robot's limit.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const ControllerFile& file);

}  // namespace joulepath
