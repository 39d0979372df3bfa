#pragma once

#include <functional>

#include "planner/values/plan.hpp"

namespace joulepath {

/// Plans a mission whose legs are given.
using PlanLegs = std::function<Plan(const MissionRequest&)>;

/// Inserts stops at chargers, where the mission allows them, until the battery never falls below its reserve:
/// each before the leg on which it would, or up to two legs earlier, at the charger with the least energy of
/// the mission. The robot stays until its state of charge is that of `charging:`. `failed` is the plan
/// without them; it is returned unchanged if no stop helps, or if chargers are no remedy.
[[nodiscard]] Plan charge_on_the_way(Plan failed, const MissionRequest& mission, const Plant& plant,
                                     const PlanLegs& plan_legs);

}  // namespace joulepath
