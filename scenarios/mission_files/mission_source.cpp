#include "scenarios/mission_files/mission_source.hpp"

#include <filesystem>

#include "model/printable.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/path_file.hpp"

namespace joulepath {
namespace {

/// The file's name without its extension; a name that is not UTF-8 is shown as such.
std::string name_of(const std::string& file) {
  return printable(std::filesystem::path(file).stem().string());
}

void refuse_beside_mission(const char* option, const char* key, bool given) {
  if (given)
    throw ConfigError({{option, 0, 0},
                       "",
                       "a value together with a mission or an order",
                       "a value only together with a path",
                       std::string("the mission file has it: ") + key});
}

MissionRequest mission_of(const MissionSource& source, const MissionDocument& document) {
  need_robot(source, document.says);
  MissionRequest mission{.file = source.file, .name = name_of(source.file)};
  document.read(mission);
  return mission;
}

}  // namespace

void need_robot(const MissionSource& source, const std::string& input) {
  if (source.robot_file.empty() && !source.robot_at_hand)
    throw ConfigError({{source.file, 1, 1},
                       "",
                       input + ", which names no robot",
                       "--robot with the name of a robot file",
                       ""});
}

void replace_file(MissionRequest& mission, const std::string& key, std::string MissionRequest::*file,
                  const std::string& given) {
  if (given.empty()) return;
  mission.*file = given;
  mission.marks.keys[key] = {.file = "--" + key};
}

MissionRequest mission_along(const MissionSource& source, Path path) {
  need_robot(source, "a path");
  MissionRequest mission{.file = source.file, .name = name_of(source.file)};
  mission.start.pose = path.start();
  LegRequest leg{.path = PathRequest{.frame = PathRequest::Frame::map, .ready = std::move(path)},
                 .duration_s = source.duration_s,
                 .marks = {.item = {.file = source.file}, .keys = {{"payload_kg", {.file = "--payload"}}}}};
  leg.payload = {source.payload_kg.value_or(0.0), source.payload_kg.value_or(0.0)};
  mission.legs.push_back(std::move(leg));
  return mission;
}

MissionRequest read_mission_source(const MissionSource& source, const ReadOptions& options,
                                   std::vector<std::string>* notes) {
  const auto with_files = [&](MissionRequest mission) {
    replace_file(mission, "robot", &MissionRequest::robot_file, source.robot_file);
    replace_file(mission, "map", &MissionRequest::map_file, source.map_file);
    return mission;
  };
  const auto along = [&](Path path) { return with_files(mission_along(source, std::move(path))); };
  if (is_waypoint_file(source.file)) return along(read_waypoints(source.file, source.tolerance_m, {}, notes));
  const Document document = Document::load(source.file);
  if (is_path(document)) return along(path_from(document, options, notes, source.tolerance_m));
  refuse_beside_mission("--payload", "payload_kg of a leg", source.payload_kg.has_value());
  refuse_beside_mission("--tolerance", "tolerance_m of a path", source.tolerance_m.has_value());
  refuse_beside_mission("--time", "duration_s of a leg", source.duration_s.has_value());
  const MissionDocument* other = mission_document_of(document);
  if (other && other->notes && notes) *notes = other->notes(source.file);
  return with_files(other ? mission_of(source, *other) : mission_from(document, options));
}

}  // namespace joulepath
