#pragma once

#include <string>

#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath::report {

/// The HTML report of a plan. `plan_json` is the text of plan.json, `trajectory` that of trajectory.csv
/// (empty where there is no plan). The baselines are driven over the same stretches and drawn over the plan.
[[nodiscard]] std::string plan_report(const Plan& plan, const std::string& plan_json,
                                      const Trajectory& trajectory, const MissionRequest& mission,
                                      const MissionWorld& world);

}  // namespace joulepath::report
