#pragma once

#include <vector>

#include "planner/profile/front.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The stretches of a plan, in the order of driving.
[[nodiscard]] std::vector<FrontStretch> planned_stretches(const Plan& plan);

/// The lowest price (W) above 0 of a second on a plan's legs; 0 where none has one. It ends the front of a
/// robot for which slower is always cheaper.
[[nodiscard]] double planned_price_W(const Plan& plan);

/// What a plan takes beside its stretches (dwell, prescribed motions): the same at every point of its front.
[[nodiscard]] FrontPoint rest_of(const Plan& plan);

/// A point of the stretches' front with the rest added.
[[nodiscard]] FrontPoint sum_of(FrontPoint point, const FrontPoint& rest);

}  // namespace joulepath
