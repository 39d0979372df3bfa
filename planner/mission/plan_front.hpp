#pragma once

#include <vector>

#include "planner/mission/mission.hpp"
#include "planner/profile/front.hpp"

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

/// The front of a mission over the ways of several plans.
struct MissionFront {
  /// Of least energy, of least time, and at a price of time between them; each only where its ways differ
  /// from those before.
  std::vector<Plan> plans{};
  /// The lowest of the fronts on their ways, what a plan takes beside its stretches included. A point's drive
  /// is the index of its plan, its ways "least_energy", "least_time" or "between".
  Front front{};
};

/// The front of a mission without times; empty where its plan is a verdict. `open`: slower is always
/// cheaper, so that the mission's times end the front.
[[nodiscard]] MissionFront mission_front(const MissionRequest& mission, const MissionWorld& world,
                                         const PlanOptions& options, std::size_t points, bool open);

}  // namespace joulepath
