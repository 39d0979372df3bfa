#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/foreign_graphs.hpp"
#include "extensions/nav2/robot_of_parameters.hpp"
#include "extensions/nav2/route_graph_file.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

FileSummary check_route_graph(const std::string& file, const ReadOptions&) {
  FileSummary summary{"route graph", "", {}};
  const RouteGraph graph = read_route_graph(file, {}, &summary.notes);
  summary.text = counted(graph.nodes.size(), "node") + ", " + counted(graph.edges.size(), "edge");
  return summary;
}

void read_named_graph(const MissionRequest& mission, MissionWorld& world) {
  if (mission.route_graph_file.empty()) return;
  const NamedBy named_by(mission.marks.at("route_graph"), "route_graph");
  world.route_graph = read_route_graph(mission.route_graph_file, named_by);
}

}  // namespace

void add_nav2(Registry& registry) {
  registry.files.push_back({.kind = "route graph", .key = "features", .check = check_route_graph});
  registry.files.push_back(
      {.kind = "route graph", .recognizes_document = is_foreign_graph, .check = check_route_graph});
  registry.files.push_back(
      {.kind = "route graph", .recognizes_file = is_graph_of_extension, .check = check_route_graph});
  registry.robots.push_back({.says = "a Nav2 or ros2_control parameter file",
                             .recognizes_document = is_parameter_file,
                             .read = read_parameters_of_robot});
  registry.robots.push_back({.says = "a fleet configuration of Open-RMF",
                             .recognizes_document = is_rmf_fleet,
                             .read = read_rmf_fleet});
  registry.kinds.push_back({"controller", controller_schema, "result of export --to controller"});
  registry.mission_keys.push_back({.key = "route_graph", .read_file = read_named_graph});
  registry.exports.push_back(
      {"controller",
       "speed, acceleration and deceleration for each leg, with the resulting energy loss (JSON)",
       export_controller, nullptr, "mission.yaml --to controller --out controller.json"});
  registry.exports.push_back({"nav2_settings",
                              "velocity smoother, RPP, MPPI and diff_drive_controller settings, with the "
                              "resulting energy loss (YAML)",
                              export_nav2_settings});
  registry.exports.push_back(
      {"speed_mask", "a Nav2 speed mask (YAML and PGM), and the resulting energy loss", export_speed_mask});
}

}  // namespace joulepath
