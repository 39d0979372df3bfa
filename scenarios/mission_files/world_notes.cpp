#include "scenarios/mission_files/world_notes.hpp"

#include <algorithm>
#include <cmath>

#include "model/printable.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/robot_files/robot_check.hpp"

namespace joulepath {
namespace {

constexpr double kMostSpeedCap = 10.0;  ///< over the robot's limit: mm/s, percent and rpm are beyond
constexpr double kUsualCell_m = 0.1;    ///< of maps of buildings, at most
constexpr double kMostOutside = 0.5;    ///< of the nodes of a route graph

constexpr const char* kCapKeys[] = {"speed_m_s", "maxSpeed", "maximumSpeed"};  ///< of missions, of orders

using WorldNotes = std::vector<std::string>;

std::string at_mark(const SourceMark& mark) {
  return mark.file.empty() ? "" : mark.file + ":" + std::to_string(mark.line) + ": ";
}

/// Width of the outline; infinite without an outline.
double width_m(const Footprint& footprint) {
  if (footprint.polygon_m.empty()) return footprint.radius_m > 0.0 ? 2 * footprint.radius_m : kNoLimit;
  const auto [right, left] =
      std::ranges::minmax(footprint.polygon_m, {}, [](const auto& corner) { return corner[1]; });
  return left[1] - right[1];
}

void note_cells(const MissionRequest& mission, const MissionWorld& world, WorldNotes& notes) {
  const double robot_m = width_m(world.robot.footprint);
  if (!world.map || world.map->resolution_m <= kUsualCell_m || world.map->resolution_m < robot_m) return;
  if (world.map->resolution_m > kCoarsestCell_m) return;  // map_doubts() tells it
  notes.push_back(mission.map_file + ": resolution: a cell of " + four_digits(world.map->resolution_m) +
                  " m is not smaller than the robot (" + four_digits(robot_m) +
                  " m); usual maps have 0.02 to 0.1 meters per pixel");
}

void note_speed_caps(const MissionRequest& mission, const Robot& robot, WorldNotes& notes) {
  if (!robot.limits || !std::isfinite(robot.limits->speed_m_s)) return;
  const auto wrong = std::ranges::find_if(mission.speed_zones, [&](const SpeedZone& zone) {
    return zone.speed_m_s > kMostSpeedCap * robot.limits->speed_m_s;
  });
  if (wrong == mission.speed_zones.end()) return;
  const auto key =
      std::ranges::find_if(kCapKeys, [&](const char* name) { return wrong->marks.keys.contains(name); });
  if (key == std::end(kCapKeys)) return;
  notes.push_back(at_mark(wrong->marks.at(*key)) + wrong->marks.path +
                  (wrong->marks.path.starts_with('/') ? "/" : ".") + *key + " " +
                  four_digits(wrong->speed_m_s) + " m/s has no effect: the robot's limits.speed_m_s is " +
                  four_digits(robot.limits->speed_m_s) + "; is it in mm/s, or in percent?");
}

void note_route_graph(const MissionRequest& mission, const MissionWorld& world, WorldNotes& notes) {
  if (!world.map || !world.route_graph || world.route_graph->nodes.empty()) return;
  const auto& nodes = world.route_graph->nodes;
  const auto outside = std::ranges::count_if(nodes, [&](const RouteGraph::Node& node) {
    const auto cell = world.map->cell_of(node.x_m, node.y_m);
    return !world.map->contains(cell) || world.map->at(cell) == 100;
  });
  if (static_cast<double>(outside) <= kMostOutside * static_cast<double>(nodes.size())) return;
  notes.push_back(at_mark(mission.marks.at("route_graph")) + "route_graph: " + std::to_string(outside) +
                  " of " + std::to_string(nodes.size()) + " nodes of " + mission.route_graph_file +
                  " lie outside of the map " + mission.map_file +
                  " or in its walls; is it another map's graph?");
}

}  // namespace

std::vector<std::string> world_notes(const MissionRequest& mission, const MissionWorld& world,
                                     const ReadOptions& options) {
  WorldNotes notes;
  const auto of_file = [&](const std::string& file, const WorldNotes& told) {
    for (const std::string& note : told) {
      notes.push_back(file.empty() ? "" : file + ": ");
      notes.back() += note;
    }
  };
  of_file(mission.robot_file, robot_notes(world.robot));
  if (world.map) of_file(mission.map_file, map_doubts(mission.map_file, options));
  note_cells(mission, world, notes);
  note_speed_caps(mission, world.robot, notes);
  note_route_graph(mission, world, notes);
  return notes;
}

}  // namespace joulepath
