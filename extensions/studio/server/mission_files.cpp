#include "extensions/studio/server/mission_files.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/json_value.hpp"
#include "scenarios/text/text_edit.hpp"

namespace joulepath::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path target = fs::weakly_canonical(file, error);
  return !error && std::mismatch(base.begin(), base.end(), target.begin(), target.end()).first == base.end();
}

Json values_of(const std::string& text, const std::string& file) {
  return json_of(Document::parse(text, file).root().value());
}

/// The names of files in a mission's values.
Json named_files(const Json& mission) {
  Json names = Json::object();
  for (const char* key : {"robot", "map", "keepout", "route_graph", "order"})
    if (mission.contains(key)) names[key] = mission.at(key);
  if (mission.contains("speed_mask") && mission["speed_mask"].is_object())
    names["speed_mask"] = mission["speed_mask"].value("file", Json());
  return names;
}

/// Throws ConfigError where a page names other files than the mission's file does.
void refuse_other_files(const Json& asked, const Json& present) {
  if (named_files(asked) == named_files(present)) return;
  throw ConfigError(
      {{}, "mission", "another file than the mission's own", "the files that the mission's file names", ""});
}

}  // namespace

MissionFiles::MissionFiles(std::string mission_file, Writer write)
    : mission_file_(std::move(mission_file)), write_(std::move(write)) {}

std::string MissionFiles::folder() const {
  const fs::path folder = fs::path(mission_file_).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string MissionFiles::robot_file() const { return read_mission(mission_file_).robot_file; }

std::string MissionFiles::copied_robot() const {
  return (fs::path(folder()) / (fs::path(mission_file_).stem().string() + "_robot.yaml")).string();
}

MissionWorld MissionFiles::read_floor() const { return read_world(read_mission(mission_file_)); }

Json MissionFiles::load() const {
  const std::string robot = robot_file();
  return state(read_text_file(mission_file_), robot, read_text_file(robot));
}

Json MissionFiles::state(const std::string& mission_text, const std::string& robot,
                         const std::string& robot_text) const {
  return {{"name", fs::path(mission_file_).stem().string()},
          {"mission_file", mission_file_},
          {"robot_file", robot},
          {"saves_robot_to", lies_in(robot, folder()) ? robot : copied_robot()},
          {"mission", values_of(mission_text, mission_file_)},
          {"robot", values_of(robot_text, robot)},
          {"base", {{"mission", mission_text}, {"robot", robot_text}}}};
}

Json MissionFiles::save(const Json& question) {
  const std::scoped_lock guard(saving_);
  const std::string robot = robot_file(), target = lies_in(robot, folder()) ? robot : copied_robot();
  const std::string mission_text = read_text_file(mission_file_), robot_text = read_text_file(robot);
  if (mission_text != question.at("base").at("mission").get<std::string>())
    return {{"conflict", mission_file_}};
  if (robot_text != question.at("base").at("robot").get<std::string>()) return {{"conflict", robot}};
  Json mission = question.at("mission");
  refuse_other_files(mission, values_of(mission_text, mission_file_));
  const std::string new_robot = with_values(robot_text, robot, question.at("robot"));
  const bool copies = new_robot != robot_text && target != robot;
  std::error_code error;
  if (copies && fs::exists(target, error)) return {{"conflict", target}};
  if (copies) mission["robot"] = fs::path(target).filename().string();
  const std::string new_mission = with_values(mission_text, mission_file_, mission);
  static_cast<void>(robot_from(Document::parse(new_robot, robot)));
  static_cast<void>(mission_from(Document::parse(new_mission, mission_file_)));
  Json saved = state(new_mission, copies ? target : robot, new_robot);  // read before anything is written
  if (new_robot != robot_text) write_(target, new_robot);
  if (new_mission != mission_text) write_(mission_file_, new_mission);
  return saved;
}

}  // namespace joulepath::studio
