#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/controller/leg_settings.hpp"

namespace joulepath {

/// What a Nav2 or ros2_control parameter file says about speeds and accelerations. Where several of its nodes
/// say it, the least holds.
struct ControllerFile {
  std::optional<double> speed_m_s{}, acceleration_m_s2{}, deceleration_m_s2{};
  std::optional<double> yaw_rate_rad_s{}, turn_rate_rad_s{};  ///< anywhere; in turns in place
  std::optional<double> yaw_acceleration_rad_s2{}, yaw_deceleration_rad_s2{};
  std::vector<std::string> read{};  ///< keys that were used, in the file's order
};

/// Reads velocity_smoother, controller_server (RPP, MPPI, DWB) and diff_drive_controller, under any node name
/// or namespace. Throws ConfigError: not YAML, or no such parameter.
[[nodiscard]] ControllerFile read_controller_settings(const std::string& file);

/// Drives a plan with them; what the file leaves open is the robot's limit.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const ControllerFile& file);

}  // namespace joulepath
