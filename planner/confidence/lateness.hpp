#pragma once

#include "model/plant.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Time (s) that a planned stretch takes longer with another plant. The robot tracks the planned speed along
/// the path; where a limit saturates it accelerates as the limits allow, until it is at the planned speed
/// again. Braking is always possible. Infinite where the robot gets stuck.
[[nodiscard]] double lateness_s(const StretchPlan& stretch, const Plant& plant, const Limits& limits);

}  // namespace joulepath
