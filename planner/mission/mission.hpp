#pragma once

#include "planner/legs/stretch.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Plans a whole mission: a path per leg, deadlines shared over the legs at equal prices of a second, an
/// energy-optimal profile per stretch, an independent replay of each, baselines, and the battery.
///
/// A mission that cannot be driven is a result (status infeasible, with the reason); mistakes in the files
/// throw ConfigError. `space`: the floor prepared for this robot, which missions on one map can share; if it
/// is absent and the mission has a map, it is prepared here.
[[nodiscard]] Plan plan_mission(const MissionRequest& mission, const MissionWorld& world,
                                const PlanOptions& options, const RouteSpace* space = nullptr);

/// The floor of a mission, prepared for its robot; absent without a map.
[[nodiscard]] std::optional<RouteSpace> route_space(const MissionRequest& mission, const MissionWorld& world);

}  // namespace joulepath
