#pragma once

#include <optional>
#include <string>
#include <vector>

#include "extensions/nav2/leg_settings.hpp"

namespace joulepath {

/// Speeds and accelerations of a Nav2 or ros2_control parameter file: the least value of the nodes that
/// drive. Or those of each leg in a result of export --to controller.
struct ControllerFile {
  std::optional<double> speed_m_s{}, acceleration_m_s2{}, deceleration_m_s2{};
  std::optional<double> yaw_rate_rad_s{}, turn_rate_rad_s{};  ///< in all motion; in turns in place
  std::optional<double> yaw_acceleration_rad_s2{}, yaw_deceleration_rad_s2{}, turn_acceleration_rad_s2{};
  std::vector<std::string> read{};  ///< the keys that were used, in the file's order
  std::string file{};
  std::vector<LegSettings> legs{};  ///< of a result of export --to controller; replaces all others
};

/// Reads velocity_smoother, controller_server (RPP, MPPI, DWB) and diff_drive_controller, in any namespace,
/// or the result of export --to controller. Other nodes are left out, as are controllers that
/// controller_plugins does not list. Throws ConfigError for a file that is not YAML or has no such parameter,
/// for several controllers that drive, and for speeds and accelerations of unknown names in what drives.
[[nodiscard]] ControllerFile read_controller_settings(const std::string& file);

/// Where the file lacks a setting, the robot's limit holds; a missing deceleration is the acceleration.
[[nodiscard]] LegSettings settings_of(const ControllerFile& file);

/// Drives a plan with these settings.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const ControllerFile& file);

}  // namespace joulepath
