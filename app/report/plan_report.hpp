#pragma once

#include <string>

#include "app/report/report.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath::report {

/// The HTML report of a plan. `plan_json` is the text of plan.json, `trajectory` that of trajectory.csv
/// (empty where there is no plan). The baselines are driven over the same stretches and drawn over the plan.
[[nodiscard]] std::string plan_report(const Plan& plan, const std::string& plan_json,
                                      const Trajectory& trajectory, const MissionRequest& mission,
                                      const MissionWorld& world, const Operation& operation = {});

/// What a page about a plan shows of its mission: names, map, way.
[[nodiscard]] MissionExtras mission_extras(const Plan& plan, const MissionRequest& mission,
                                           const MissionWorld& world);

}  // namespace joulepath::report
