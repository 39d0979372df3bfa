#pragma once

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// Settings of a controller for one leg: trapezoids along its curves and in its turns in place; without a
/// value the robot's limits hold.
struct LegSettings {
  std::optional<TrapezoidSettings> drive{};
  std::optional<TrapezoidSettings> turn{};
  double yaw_rate_rad_s{kNoLimit}, yaw_acceleration_rad_s2{kNoLimit};  ///< along curves
};

/// Settings of least energy for each leg of a valid plan in the plan's time: one triple for all curves of a
/// leg and one for all its turns. A pattern search over trapezoids finds the accelerations; the time of the
/// controller's own drive determines the cruise speed. Rounded up to millionths, so that the controller is
/// not late. Where no cruise speed is as fast as the plan, the robot's limits.
[[nodiscard]] std::vector<LegSettings> leg_settings(const Plan& plan);

/// One set for all curves of a plan and one for all its turns, for controllers that cannot change settings
/// between legs. Turns have one acceleration for both directions.
[[nodiscard]] LegSettings mission_settings(const Plan& plan);

/// The mission driven with these settings.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const std::vector<LegSettings>& settings);

}  // namespace joulepath
