#include "scenarios/mission_files/plan_robot.hpp"

#include <filesystem>

#include "planner/cache/content_key.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {

PlanRobot plan_robot(const Robot& robot) {
  Robot nameless = robot;
  nameless.name.clear();
  nameless.uncertainty.clear();
  nameless.uncertainty_correlations.clear();
  return {robot.name, content_key(robot_text(nameless)).text()};
}

void check_plan_robot(const std::string& directory, const Robot& robot) {
  const std::string file = (std::filesystem::path(directory) / "plan.json").string();
  if (!std::filesystem::exists(file)) return;
  const auto plan = shallow_json(read_text_file(file));
  if (!plan.is_object() || !plan.contains("robot") || !plan["robot"].is_object()) return;
  const auto said = [&](const char* key) {
    const auto found = plan["robot"].find(key);
    return found != plan["robot"].end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const PlanRobot given = plan_robot(robot);
  if (said("fingerprint") == given.fingerprint) return;
  const bool same_name = said("name") == given.name;
  throw ConfigError(
      {{file, 0, 0},
       "robot",
       std::string("a plan of ") + (same_name ? "other values of robot '" : "robot '") + said("name") + "'",
       "a plan of the robot '" + given.name + "' that --robot names",
       "plan again with this robot file"});
}

}  // namespace joulepath
