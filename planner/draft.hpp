#pragma once

#include <vector>

#include "planner/leg_choice.hpp"
#include "planner/leg_timing.hpp"

namespace joulepath {

/// Everything about a mission that is known before its times are.
struct Draft {
  std::vector<LegTiming> timing{};
  std::vector<LegPlan> legs{};
};

/// Turns a plan into a verdict.
[[nodiscard]] Plan infeasible(Plan plan, std::size_t leg, double arc_length_m, Infeasibility reason);

/// Paths and profile requests of all legs, each chosen at its price of a second; where a leg has none, the
/// plan becomes the verdict and the draft is not complete. `ways` is filled, and used where a leg begins as
/// it did in an earlier round.
[[nodiscard]] Draft draft_legs(const MissionRequest& mission, const MissionWorld& world,
                               const RouteSpace* space, const Plant& plant, const PlanOptions& options,
                               const std::vector<double>& price_W, std::vector<LegWays>& ways, Plan& plan);

/// Whether every stretch can be driven at all; the plan becomes the verdict where one cannot.
[[nodiscard]] bool check_each_leg(Draft& draft, double price_W, SolverChoice solver, Plan& plan);

}  // namespace joulepath
