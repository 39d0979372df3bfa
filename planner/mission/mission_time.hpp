#pragma once

#include <utility>

#include "planner/mission/prepared_legs.hpp"
#include "planner/mission/time_split.hpp"

namespace joulepath {

/// The price of a second without a binding deadline (W, beyond standby); infinite for minimum time.
[[nodiscard]] double lowest_price_W(const Objective& objective);

/// Times of all legs: fixed durations as given, all others at equal prices within the deadlines. If windings
/// warm up, every stretch gets the time of day at which it begins.
[[nodiscard]] TimeSplit share_time(PreparedLegs& prepared, const MissionRequest& mission, const Plant& plant,
                                   SolverChoice solver);

/// Place of the robot on a leg (arc length, pose) `elapsed_s` after its departure, at minimum time.
[[nodiscard]] std::pair<double, Pose> place_after(LegTiming& leg, double elapsed_s, SolverChoice solver);

}  // namespace joulepath
