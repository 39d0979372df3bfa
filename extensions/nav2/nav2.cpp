#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/route_graph_file.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

FileSummary check_route_graph(const std::string& file, const ReadOptions&) {
  return {"route graph", counted(read_route_graph(file).nodes.size(), "node"), {}};
}

void read_named_graph(const MissionRequest& mission, MissionWorld& world) {
  if (mission.route_graph_file.empty()) return;
  const NamedBy named_by(mission.marks.at("route_graph"), "route_graph");
  world.route_graph = read_route_graph(mission.route_graph_file, named_by);
}

}  // namespace

void add_nav2(Registry& registry) {
  registry.files.push_back({.kind = "route graph", .key = "features", .check = check_route_graph});
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
