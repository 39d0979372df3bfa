#pragma once

#include <functional>

#include "planner/values/plan.hpp"

namespace joulepath {

/// Plans a mission whose legs are given.
using PlanLegs = std::function<Plan(const MissionRequest&)>;

/// Inserts stops at chargers, where the mission allows them, until the state of charge never falls below the
/// reserve. Each stop is inserted before the leg that would breach the reserve, up to two legs earlier, or
/// where it is cheaper by estimate, at the charger that gives the mission the lowest cost by its objective;
/// where none of these helps, still earlier, down to the mission's start. The robot charges up to the state
/// of charge of `charging:`. Stops are compared by `plan_legs`; the mission with the stops that win is then
/// planned by `plan_refined`, where there is one: the same with paths that are refined, which take most of
/// the time. Only where that fails, a few stops are tried with refined paths. `failed` is the plan without
/// these stops; it is returned, with a note, if no stop that is tried helps, and unchanged if chargers cannot
/// remedy the failure.
[[nodiscard]] Plan charge_on_the_way(Plan failed, const MissionRequest& mission, const Plant& plant,
                                     const PlanLegs& plan_legs, const PlanLegs& plan_refined);

}  // namespace joulepath
