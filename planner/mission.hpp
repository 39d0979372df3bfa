#pragma once

#include "planner/plan.hpp"
#include "planner/stretch.hpp"

namespace joulepath {

/// Plans a whole mission: a path per leg, deadlines shared over the legs at equal prices of a second, an
/// energy-optimal profile per stretch, an independent replay of each, baselines, and the battery.
///
/// What cannot be driven comes back as data (status infeasible, with the reason); mistakes in the files
/// throw ConfigError.
[[nodiscard]] Plan plan_mission(const MissionRequest& mission, const MissionWorld& world,
                                const PlanOptions& options);

}  // namespace joulepath
