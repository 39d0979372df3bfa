#include <iostream>

#include "app/command_line.hpp"
#include "app/export_task.hpp"
#include "app/terminal.hpp"
#include "extensions/nav2/route_graph_export.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

class RouteGraphTask : public ExportTask {
 public:
  RouteGraphTask()
      : ExportTask(
            "route_graph",
            "a Nav2 route graph (GeoJSON) with energy, time and speed on each edge, and the route server's "
            "settings (YAML)",
            "graph.geojson --robot robot.yaml --payload 5 --to route_graph --out energy.geojson") {}

  void declare(CommandLine& line) override {
    line.option("--corner-radius", corner_radius_m_,
                "route_graph: radius of the arcs that the robot drives in corners, m; 0: it stops and turns")
        .not_negative()
        .shows_default();
    line.flag("--expand-turns", expand_turns_,
              "route_graph: a node per arriving edge, so that costs of corners are exact");
  }

  int run(const ExportArguments& arguments) override {
    const MissionSource& source = arguments.source;
    need_robot(source, "a route graph");
    const Robot robot = read_robot(source.robot_file);
    const double payload_kg = source.payload_kg.value_or(0.0);
    check_payload(payload_kg, robot, source.robot_file, {{"--payload", 0, 0}, ""});
    const RouteGraphExport result =
        export_route_graph({source.file, arguments.out, payload_kg, corner_radius_m_, expand_turns_}, robot);
    write_export_files(result.files, arguments.common);
    for (const std::string& warning : result.warnings) std::cerr << "warning: " << warning << "\n";
    if (arguments.common.quiet) return kDone;
    std::cout << result.nodes << " nodes, " << result.edges << " edges\n";
    if (!result.arcs.empty()) std::cout << result.arcs << "\n";
    const TurnAttribution& turns = result.attribution;
    if (turns.corners > 0)
      std::cout << "corners: " << turns.corners << ", mean " << figure(turns.mean_J, 3)
                << " J; edges alone miss a corner by " << figure(turns.rms_J, 3) << " J (rms), "
                << figure(turns.worst_J, 3) << " J (worst): --expand-turns is exact\n";
    if (result.goal_offset > 0)
      std::cout
          << "ask for routes by ids: start_id is a node's own id, goal_id the id of the node to reach + "
          << result.goal_offset << "\n";
    tell_export_files(result.files);
    return kDone;
  }

 private:
  double corner_radius_m_{};
  bool expand_turns_{};
};

}  // namespace

std::unique_ptr<ExportTask> make_route_graph_task() { return std::make_unique<RouteGraphTask>(); }

}  // namespace joulepath
