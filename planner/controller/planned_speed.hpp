#pragma once

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// Parts of a leg that can each have a speed: those that the mission names, else the segments of its curves.
[[nodiscard]] std::vector<PathPart> leg_parts(const LegPlan& leg);

/// A speed for each part of each leg of a plan: [leg][part], in m/s; 0 on parts without any length.
using PartSpeeds = std::vector<std::vector<double>>;

/// The plan's highest speed on each part, times `scale`, rounded up to whole mm/s.
[[nodiscard]] PartSpeeds part_speeds(const Plan& plan, double scale);

/// Those speeds as caps on a stretch.
[[nodiscard]] std::vector<SpeedCap> caps_on(const PartSpeeds& speeds, const StretchPlace& place,
                                            const StretchPlan& stretch, const LegPlan& leg);

/// The scale in (0, 1] of the speed caps with which a controller takes the plan's time; 1 where the
/// controller is not earlier without caps. `drive` returns the drive for a scale.
[[nodiscard]] double scale_for_plan_time(const Plan& plan,
                                         const std::function<ControlledDrive(double)>& drive);

}  // namespace joulepath
