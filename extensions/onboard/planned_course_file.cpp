#include "extensions/onboard/planned_course_file.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "extensions/onboard/planned_trajectory.hpp"
#include "model/normal_quantiles.hpp"
#include "scenarios/mission_files/plan_robot.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

double sigma_of(const Json& interval) {
  if (!interval.is_array() || interval.size() != 2) return 0.0;
  return (interval[1].get<double>() - interval[0].get<double>()) / (2 * kNormal95);
}

}  // namespace

PlannedCourse read_planned_course(const std::string& directory, const Robot& robot) {
  check_plan_robot(directory, robot);
  const std::filesystem::path folder = directory;
  PlannedCourse course = planned_course(
      robot.geometry, read_planned_trajectory(directory, {"time_s", "wheel_speed_left_rad_s",
                                                          "wheel_speed_right_rad_s", "energy_J"}));
  const std::string file = (folder / "plan.json").string();
  if (!std::filesystem::exists(file)) return course;
  const Json plan = Json::parse(read_text_file(file), nullptr, false);
  if (!plan.is_object())
    throw ConfigError({{file, 1, 1}, "", "no JSON object", "the plan.json of a plan", ""});
  if (const Json sigma_J = plan.value("energy_sigma_J", Json()); sigma_J.is_number())
    course.sigma_J = sigma_J.get<double>();
  for (const Json& leg : plan.value("legs", Json::array()))
    course.legs.push_back({leg.value("energy_J", 0.0), sigma_of(leg.value("energy_interval_95_J", Json()))});
  const Json battery = plan.value("battery", Json());
  if (battery.is_object() && battery.contains("start_fraction"))
    course.battery_fraction = battery["start_fraction"].get<double>();
  return course;
}

}  // namespace joulepath
