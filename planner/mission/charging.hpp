#pragma once

#include <functional>

#include "planner/values/plan.hpp"

namespace joulepath {

/// Plans a mission whose legs are given.
using PlanLegs = std::function<Plan(const MissionRequest&)>;

/// Puts in stops at chargers, where the mission allows them, until the battery's reserve is never touched:
/// each before the leg on which it would be, or up to two legs earlier, at the charger with which the mission
/// takes least energy. The robot stays until its state of charge is what `charging:` says. `failed` is the
/// plan without them; it comes back as it is where no stop helps, or where chargers are no remedy.
[[nodiscard]] Plan charge_on_the_way(Plan failed, const MissionRequest& mission, const Plant& plant,
                                     const PlanLegs& plan_legs);

}  // namespace joulepath
