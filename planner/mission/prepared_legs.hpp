#pragma once

#include <vector>

#include "planner/legs/leg_timing.hpp"
#include "planner/values/plan.hpp"
#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// The part of a mission's plan that does not depend on its times.
struct PreparedLegs {
  std::vector<LegTiming> timing{};
  std::vector<LegPlan> legs{};
};

/// What a leg leads to: a station, `path` or `motion`.
[[nodiscard]] std::string goal_name(const LegRequest& leg);
/// Makes the plan infeasible with a verdict.
[[nodiscard]] Plan infeasible(Plan plan, std::size_t leg, double arc_length_m, Infeasibility reason);
/// Makes the plan a failure of the solvers.
[[nodiscard]] Plan failed(Plan plan, std::string reason);

/// Profile requests of all legs along their paths, each in its state (none: the robot as it is). If a leg has
/// no path, or cannot be driven for another reason that needs no solver, the plan becomes the verdict and the
/// legs are incomplete.
[[nodiscard]] PreparedLegs prepare_legs(const MissionRequest& mission, const MissionWorld& world,
                                        const Plant& plant, const PlanOptions& options,
                                        const std::vector<LegState>& states, std::vector<LegPath> paths,
                                        Plan& plan);

/// Speeds at the ends of a leg are speeds of driving: throws ConfigError for a speed above 0 if the leg
/// begins or ends with a turn in place there.
void check_end_speeds(const PreparedLegs& prepared, const MissionRequest& mission);

/// Whether all stretches of a leg have profiles; if not, the plan becomes the verdict with its reason.
[[nodiscard]] bool all_driven(std::size_t leg, const PreparedLegs& prepared,
                              const std::vector<ProfileResult>& results, Plan& plan);

/// Whether every stretch can be driven at all; if not, the plan becomes the verdict.
[[nodiscard]] bool check_each_leg(PreparedLegs& prepared, double price_W, SolverChoice solver, Plan& plan);

}  // namespace joulepath
