#pragma once

#include "planner/legs/stretch.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Plans a whole mission: a path per leg, deadlines shared over the legs at equal prices of a second, an
/// energy-optimal profile per stretch, an independent replay of each, baselines, and the battery.
///
/// What cannot be driven comes back as data (status infeasible, with the reason); mistakes in the files
/// throw ConfigError. `space`: the floor prepared for this robot, to be shared by missions on one map; it is
/// prepared here when none is given and the mission has a map.
[[nodiscard]] Plan plan_mission(const MissionRequest& mission, const MissionWorld& world,
                                const PlanOptions& options, const RouteSpace* space = nullptr);

/// The floor of a mission as its robot sees it; absent without a map.
[[nodiscard]] std::optional<RouteSpace> route_space(const MissionRequest& mission, const MissionWorld& world);

}  // namespace joulepath
