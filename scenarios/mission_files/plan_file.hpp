#pragma once

#include <optional>
#include <string>

#include "planner/values/plan.hpp"
#include "scenarios/mission_files/plan_robot.hpp"

namespace joulepath {

/// `plan.json` of a plan (schema joulepath/plan/1): keys in a fixed order, the same bytes for the same plan.
/// `robot`: the robot that it is for.
[[nodiscard]] std::string plan_json_text(const Plan& plan, const std::optional<PlanRobot>& robot = {});

/// line, headings or corners.
[[nodiscard]] const char* path_bound_part_name(PathBound::Part part);

/// What the 95 % intervals of a plan hold, or why it has none: "unknown: ...".
[[nodiscard]] const char* uncertainty_text(const Plan& plan);

/// `energy_by_cause_J` of a plan.json.
[[nodiscard]] std::string cause_json_text(const EnergyByCause& energy);

}  // namespace joulepath
