#pragma once

#include <functional>
#include <vector>

#include "planner/legs/stretch.hpp"
#include "planner/values/plan.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {

/// The least voltage and the greatest resistances of some states.
[[nodiscard]] LegState hardest(const std::vector<LegState>& states);

/// Plans a mission's legs, each in a given state.
using PlanInStates = std::function<Plan(const std::vector<LegState>&)>;

/// A plan whose legs are in the states that it leads to: the states of a plan are those of the next one,
/// until they stay. The first one begins with cold windings and an undrawn charge, so that its bounds are
/// those of every plan. A leg has the least open-circuit voltage of its charges. Where windings are too hot,
/// the least price of heat that keeps them is paid, unless the least time is asked for.
[[nodiscard]] Plan settled_plan(const MissionRequest& mission, const Robot& robot, const PlanOptions& options,
                                const PlanInStates& plan);

}  // namespace joulepath
