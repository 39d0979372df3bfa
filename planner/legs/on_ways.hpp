#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

/// A mission whose legs follow the paths of its plan, in the plan's order of visits; prescribed motions stay.
/// The mission itself where the plan inserted stops at chargers.
[[nodiscard]] MissionRequest on_ways_of(const Plan& plan, const MissionRequest& mission);

}  // namespace joulepath
