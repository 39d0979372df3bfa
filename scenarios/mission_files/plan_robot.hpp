#pragma once

#include <string>

#include "model/robot.hpp"

// Design: docs/decisions/0600-input-files.md
namespace joulepath {

/// The robot of a plan, as plan.json says it.
struct PlanRobot {
  std::string name{};
  std::string fingerprint{};  ///< of all values of the robot file but its name and its uncertainty
};

[[nodiscard]] PlanRobot plan_robot(const Robot& robot);

/// Throws ConfigError if the plan.json of a plan's directory says that it is the plan of another robot. A
/// plan without plan.json, or written without its robot, says nothing.
void check_plan_robot(const std::string& directory, const Robot& robot);

}  // namespace joulepath
