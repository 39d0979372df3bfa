#pragma once

#include <utility>

#include "planner/mission/prepared_legs.hpp"
#include "planner/mission/time_split.hpp"

namespace joulepath {

/// What a second is worth where no deadline binds (W, on top of standby); infinite for minimum time.
[[nodiscard]] double lowest_price_W(const Objective& objective);

/// Times of all legs: fixed durations on their own, all others at equal prices within the deadlines. Where
/// windings warm up, every stretch gets the time of day at which it begins.
[[nodiscard]] TimeSplit share_time(PreparedLegs& prepared, const MissionRequest& mission, const Plant& plant,
                                   SolverChoice solver);

/// Where the robot is on a leg (arc length, pose) when `elapsed_s` have passed since its departure, at
/// minimum time.
[[nodiscard]] std::pair<double, Pose> place_after(LegTiming& leg, double elapsed_s, SolverChoice solver);

}  // namespace joulepath
