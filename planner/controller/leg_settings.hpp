#pragma once

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// Settings of a controller for one leg: trapezoids along its curves and in its turns in place; absent where
/// the leg has no curve or no turn.
struct LegSettings {
  std::optional<TrapezoidSettings> drive{};
  std::optional<TrapezoidSettings> turn{};
};

/// Settings of least energy for each leg of a valid plan in the plan's time: one triple for all curves of a
/// leg and one for all its turns. A pattern search finds the accelerations; the time determines the cruise
/// speed. They are rounded up to three decimals, so that the controller is not late. Where no trapezoid is as
/// fast as the plan, the robot's limits.
[[nodiscard]] std::vector<LegSettings> leg_settings(const Plan& plan);

/// One set for all curves of a plan and one for all its turns, for controllers that cannot change settings
/// between legs.
[[nodiscard]] LegSettings mission_settings(const Plan& plan);

/// The mission driven with these settings.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const std::vector<LegSettings>& settings);

}  // namespace joulepath
