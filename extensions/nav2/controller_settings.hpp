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
  std::optional<double> reverse_speed_m_s{};                  ///< no comparison needs it
  std::optional<double> yaw_rate_rad_s{}, turn_rate_rad_s{};  ///< in all motion; in turns in place
  std::optional<double> yaw_acceleration_rad_s2{}, yaw_deceleration_rad_s2{}, turn_acceleration_rad_s2{};
  std::vector<std::string> read{};  ///< the keys that were used, in the file's order
  std::vector<int> lines{};         ///< of these keys
  std::vector<std::pair<std::optional<double> ControllerFile::*, double>> sizes{};  ///< that they state
  std::vector<std::string> unused{};        ///< keys and lines of what looks like a limit and is not used
  std::vector<std::string> not_modelled{};  ///< what each controller does beside its limits, in words
  std::string file{};
  std::vector<LegSettings> legs{};  ///< of a result of export --to controller; replaces all others
};

/// Reads velocity_smoother, controller_server (RPP, MPPI, DWB, Graceful, TEB) and diff_drive_controller, in
/// any namespace, nested or with dotted keys, or the result of export --to controller. Other nodes are left
/// out, as are controllers that controller_plugins does not list; `plugin` names the one that drives where
/// several could. Throws ConfigError for a file that is not YAML or has no such parameter, for several
/// controllers that drive, for parameters of ROS 1, and for speeds and accelerations of unknown names in a
/// plugin of a type that is not known; those of known types are listed as unused.
[[nodiscard]] ControllerFile read_controller_settings(const std::string& file,
                                                      const std::string& plugin = {});

/// Where the file lacks a setting, the robot's limit holds; a missing deceleration is the acceleration.
[[nodiscard]] LegSettings settings_of(const ControllerFile& file);

/// Drives a plan with these settings.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const ControllerFile& file);

}  // namespace joulepath
