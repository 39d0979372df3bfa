#pragma once

#include <utility>
#include <vector>

#include "planner/mission/prepared_legs.hpp"
#include "planner/mission/time_split.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The price of a second without a binding deadline (W, beyond standby); infinite for minimum time.
[[nodiscard]] double lowest_price_W(const Objective& objective);

/// The cost (J) by an objective: the energy, with the time at the price of a second; the time (s) alone for
/// minimum time.
[[nodiscard]] double cost(double energy_J, double time_s, const Objective& objective);
[[nodiscard]] double cost(const Plan& plan, const Objective& objective);

/// Times of all legs: fixed durations as given, all others at equal prices within the deadlines. If windings
/// warm up, every stretch gets the time of day at which it begins.
[[nodiscard]] TimeSplit share_time(PreparedLegs& prepared, const MissionRequest& mission, const Plant& plant,
                                   SolverChoice solver);

/// The price (W) at which ways are chosen first: the lowest one, or 1 W where a second without a price costs
/// the robot nothing, so that slower would always be cheaper.
[[nodiscard]] double first_price_W(const MissionRequest& mission, const MissionWorld& world,
                                   const Plant& plant);

/// True if prices changed so much that another way may be better.
[[nodiscard]] bool prices_moved(const std::vector<double>& before_W, const std::vector<double>& after_W);

/// The price (W) at which ways lie between those of least energy and of least time.
[[nodiscard]] double middle_price_W(const Plan& plan);
/// What a plan with a deadline and a front try beside it, in middle prices: one without the other was up to
/// 0.2 % dearer than the other.
inline constexpr double kCalmer = 0.25;

/// Bounds the times of legs on which slower is always cheaper, by far more than their deadlines or durations
/// allow. Throws ConfigError where a mission gives them no time.
void bound_open_times(PreparedLegs& prepared, const MissionRequest& mission);

/// Place of the robot on a leg (arc length, pose) `elapsed_s` after its departure from a pose, at minimum
/// time.
[[nodiscard]] std::pair<double, Pose> place_after(LegTiming& leg, Pose pose, double elapsed_s,
                                                  SolverChoice solver);

}  // namespace joulepath
