#pragma once

#include <vector>

#include "planner/legs/leg_timing.hpp"
#include "planner/values/plan.hpp"
#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// Everything about a mission that is known before its times are.
struct PreparedLegs {
  std::vector<LegTiming> timing{};
  std::vector<LegPlan> legs{};
};

/// Turns a plan into a verdict.
[[nodiscard]] Plan infeasible(Plan plan, std::size_t leg, double arc_length_m, Infeasibility reason);
/// Turns a plan into one that the solvers did not find.
[[nodiscard]] Plan failed(Plan plan, std::string reason);

/// Profile requests of all legs along their paths; where a leg has none, or cannot be driven for another
/// reason that needs no solver, the plan becomes the verdict and the legs are not complete.
[[nodiscard]] PreparedLegs prepare_legs(const MissionRequest& mission, const MissionWorld& world,
                                        const Plant& plant, const PlanOptions& options,
                                        std::vector<LegPath> paths, Plan& plan);

/// Speeds at the ends of a leg are those of driving: throws ConfigError at a speed above 0 where the leg
/// begins or ends with a turn in place.
void check_end_speeds(const PreparedLegs& prepared, const MissionRequest& mission);

/// Whether all stretches of a leg have profiles; the plan becomes the verdict, with its reason, where one has
/// none.
[[nodiscard]] bool all_driven(std::size_t leg, const std::vector<ProfileRequest>& stretches,
                              const std::vector<ProfileResult>& results, Plan& plan);

/// Whether every stretch can be driven at all; the plan becomes the verdict where one cannot.
[[nodiscard]] bool check_each_leg(PreparedLegs& prepared, double price_W, SolverChoice solver, Plan& plan);

}  // namespace joulepath
