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

/// Whether a mission is planned with a state of charge at its start.
using PlansWithFraction = std::function<bool(double)>;

/// Adds to the verdict on a mission that a fuller battery may drive the least `battery_fraction`, in
/// hundredths, with which it was planned; a verdict on the battery itself gets no other relaxation then.
/// For batteries with a curve.
void offer_charge(Plan& plan, const Robot& robot, double start_fraction, const PlansWithFraction& plans);

/// Whether a mission is planned with a battery of this capacity (Wh).
using PlansWithCapacity = std::function<bool(double)>;

/// Adds the capacity with which a mission that falls below the reserve was planned, to 2 %. For batteries
/// with a curve whose verdict has no other relaxation.
void offer_capacity(Plan& plan, const Robot& robot, const PlansWithCapacity& plans);

/// Whether a changed mission is planned.
using PlansMission = std::function<bool(const MissionRequest&)>;

/// Adds to the verdict on windings that are too hot the least dwell at every stop and the greatest payload
/// with which the mission was planned: to 10 %, and in steps of 5 %. `mission` is the one that was asked for.
void offer_cooling(Plan& plan, const MissionRequest& mission, const PlansMission& plans);

}  // namespace joulepath
