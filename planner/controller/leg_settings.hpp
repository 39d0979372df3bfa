#pragma once

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// What a controller is set to for one leg: trapezoids along its curves and in its turns in place; absent
/// where it has none.
struct LegSettings {
  std::optional<TrapezoidSettings> drive{};
  std::optional<TrapezoidSettings> turn{};
};

/// Settings for each leg of a valid plan that cost least in the plan's own time: one triple for all curves of
/// a leg, one for all its turns, accelerations by a pattern search, the cruise speed by the time. Rounded up
/// to three decimals, so that the controller is not late. Where no trapezoid is as fast as the plan, the
/// robot's limits.
[[nodiscard]] std::vector<LegSettings> leg_settings(const Plan& plan);

/// One set for all curves of a plan and one for all its turns, for controllers that keep theirs.
[[nodiscard]] LegSettings mission_settings(const Plan& plan);

/// The mission driven with them.
[[nodiscard]] ControlledDrive drive_with(const Plan& plan, const std::vector<LegSettings>& settings);

}  // namespace joulepath
