#include <algorithm>
#include <sstream>

#include "model/limit_table.hpp"
#include "planner/confidence/confident_plan.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_check.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

/// A payload above the robot's limit is an error of the mission, reported at the leg.
void check_payloads(const MissionRequest& request, const Robot& robot) {
  const auto check = [&](double payload_kg, const ItemMarks& marks) {
    check_payload(payload_kg, robot, request.robot_file,
                  {marks.at("payload_kg"), marks.key_path("payload_kg")});
  };
  for (const auto& leg : request.legs) check(std::max(leg.payload.from_kg, leg.payload.to_kg), leg.marks);
  for (const auto& visit : request.visit) check(visit.payload_kg, visit.marks);
}

/// The key that names a file, or the option that replaces it.
NamedBy naming(const MissionRequest& request, const char* key) {
  const SourceMark& mark = request.marks.at(key);
  return {mark, mark.line > 0 ? key : ""};
}

}  // namespace

void check_payload(double payload_kg, const Robot& robot, const std::string& robot_file,
                   const NamedBy& named_by) {
  const double most_kg = payload_limit_kg(robot);
  if (payload_kg <= most_kg) return;
  std::ostringstream found, accepted;
  found << payload_kg;
  accepted << "at most " << most_kg << ", limits." << payload_limit().key << " of "
           << (robot_file.empty() ? "the robot" : robot_file);
  throw ConfigError({named_by.mark, named_by.key, found.str(), accepted.str(), ""});
}

void check_footprint(const MissionRequest& request, const Robot& robot) {
  if (has_footprint(robot) || request.map_file.empty()) return;
  throw ConfigError({{request.robot_file, 1, 1},
                     "footprint",
                     "nothing, although the robot drives on the map " + request.map_file,
                     "footprint: {radius_m: } or {polygon_m: }",
                     "every path is checked against the map"});
}

MissionWorld read_world(const MissionRequest& request, const ReadOptions& options, const Robot* robot) {
  const Robot used = robot ? *robot : read_robot(request.robot_file, naming(request, "robot"));
  check_payloads(request, used);
  check_footprint(request, used);
  need_uncertainty(request, used);
  return read_named_files(request, options, &used);
}

MissionWorld read_named_files(const MissionRequest& request, const ReadOptions& options, const Robot* robot) {
  const auto named = [&](const char* key) { return naming(request, key); };
  MissionWorld world{.robot = robot ? *robot : read_robot(request.robot_file, named("robot"))};
  if (!request.map_file.empty()) world.map = read_map(request.map_file, named("map"), options);
  if (world.map && request.unknown_is_floor)
    std::ranges::replace(world.map->occupancy_percent, kUnknownCell, std::int8_t{0});
  if (!request.keepout_file.empty())
    world.keepout = read_map(request.keepout_file, named("keepout"), options);
  if (request.speed_mask)
    world.speed_mask =
        SpeedMask{read_map(request.speed_mask->file, named("speed_mask"), options), request.speed_mask->kind,
                  request.speed_mask->base, request.speed_mask->multiplier};
  for (const MissionKey& known : registry().mission_keys)
    if (known.read_file) known.read_file(request, world);
  return world;
}

void visit_files_read_by(const MissionRequest& request, const ReadOptions& options,
                         const std::function<void(const std::string&)>& visit) {
  for (const std::string& file : {request.robot_file, request.order_file, request.route_graph_file})
    if (!file.empty()) visit(file);
  for (const std::string& file : {request.map_file, request.keepout_file,
                                  request.speed_mask ? request.speed_mask->file : std::string()}) {
    if (file.empty()) continue;
    visit(file);
    visit(map_image_file(file, options));
  }
}

}  // namespace joulepath
