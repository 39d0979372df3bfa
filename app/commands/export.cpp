#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/loss_table.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "app/terminal.hpp"
#include "model/text_of_list.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/bags/bag_log.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/export/route_graph.hpp"
#include "scenarios/mission_file.hpp"
#include "scenarios/robot_file.hpp"
#include "scenarios/run_log.hpp"
// Design: docs/decisions/0603-orders-and-exports.md
namespace joulepath {
namespace {

const ExportFormat& format_named(const std::string& name) {
  for (const ExportFormat& format : export_formats())
    if (format.name == name) return format;
  throw UsageError("no format '" + name + "'");
}

std::string examples() {
  std::string text =
      "  joulepath export mission.yaml --to nav2_path --out path.json\n"
      "  joulepath export path.csv --robot robot.yaml --time 30 --to trajectory --out trajectory.json\n"
      "  joulepath export mission.yaml --to controller --out controller.json\n"
      "  joulepath export order.json --robot robot.yaml --to vda5050 --out slower.json\n"
      "  joulepath export logs/run_01.csv --robot robot.yaml --to bag --out log.mcap\n"
      "  joulepath export graph.geojson --robot robot.yaml --payload 5 --to route_graph --out "
      "energy.geojson\n\nFormats:\n";
  const auto line = [&](const std::string& name, const std::string& says) {
    text += "  " + name + std::string(15 - name.size(), ' ') + says + "\n";
  };
  for (const ExportFormat& format : export_formats()) line(format.name, format.says);
  line(kRouteGraphFormat, kRouteGraphSays);
  return text;
}

class ExportCommand : public Command {
 public:
  ExportCommand()
      : Command({.name = "export",
                 .says = "plan a mission, or take a log, and write it in the format of another program",
                 .examples = examples()}) {}

  void declare(CommandLine& line) override {
    std::vector<std::string> names;
    for (const ExportFormat& format : export_formats()) names.push_back(format.name);
    names.push_back(kRouteGraphFormat);
    add_mission_source(line, source_);
    line.option("--to", format_, "format").required().one_of(names);
    line.option("--out", out_, "file to write; further files use its name").required();
    line.option("--rate", rate_Hz_, "samples per second, for formats with samples").between(0.1, 1000.0);
    line.option("--corner-radius", corner_radius_m_,
                "route_graph: radius of the arcs that the robot drives in corners, m; 0: it stops and turns")
        .not_negative()
        .shows_default();
    line.flag("--expand-turns", expand_turns_,
              "route_graph: a node per arriving edge, so that costs of corners are exact");
    add_plan_options(line, options_);
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    const ReadOptions reading{.untrusted = common_.untrusted};
    if (format_ == kRouteGraphFormat) return write_route_graph();
    if (format_ == "bag" && is_run_log(source_.file)) return write_log_bag();
    const ExportFormat& format = format_named(format_);
    check_extension();
    const MissionRequest mission = read_mission_source(source_, reading);
    const MissionWorld world = read_world(mission, reading);
    options_.solver = SolverChoice::fast;
    options_.baselines = false;  // exports do not use the plan's own baselines
    const Plan plan = plan_mission(mission, world, options_);
    if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) {
      std::cerr << "no plan to export: " << solve_status_name(plan.status) << ": " << plan.message << "\n";
      return kInfeasibleOrFailed;
    }
    const Plant plant = make_plant(world.robot);
    const Export result = format.write({mission, world, plan, plant, out_, rate_Hz_});
    write_files(result.files);
    if (common_.json && result.loss)
      std::cout << loss_json_text(*result.loss, format_);
    else if (!common_.quiet)
      tell(plan, result);
    return kDone;
  }

 private:
  /// A table is written as CSV or JSON, depending on the name's extension.
  void check_extension() const {
    const std::string extension = std::filesystem::path(out_).extension().string();
    if (format_ == "edges" && extension != ".csv" && extension != ".json")
      throw ConfigError(
          {{out_, 0, 0}, "", "a name that ends neither with .csv nor .json", "one of them", ""});
  }

  /// All or none: an existing file is reported before anything is written.
  void write_files(const std::vector<ExportFile>& files) const {
    for (const ExportFile& file : files)
      if (!common_.force && std::filesystem::exists(file.name))
        throw ConfigError(
            {{file.name, 0, 0}, "", "a file that exists", "a new name", "--force overwrites it"});
    for (const ExportFile& file : files) write_output_file(file.name, file.content, common_.force);
  }

  void need_robot(const char* input) const {
    if (source_.robot_file.empty())
      throw ConfigError({{source_.file, 0, 0},
                         "",
                         std::string(input) + ", which names no robot",
                         "--robot with the name of a robot file",
                         ""});
  }

  int write_log_bag() const {
    need_robot("a log");
    const Geometry geometry = read_robot(source_.robot_file).geometry;
    const std::vector<ExportFile> files{
        {out_, log_bag(read_run_log(source_.file, geometry).trajectory, geometry)}};
    write_files(files);
    if (!common_.quiet) tell_names(files);
    return kDone;
  }

  int write_route_graph() const {
    need_robot("a route graph");
    const Robot robot = read_robot(source_.robot_file);
    const double payload_kg = source_.payload_kg.value_or(0.0);
    check_payload(payload_kg, robot, source_.robot_file, {{"--payload", 0, 0}, ""});
    const RouteGraphExport result =
        export_route_graph({source_.file, out_, payload_kg, corner_radius_m_, expand_turns_}, robot);
    write_files(result.files);
    for (const std::string& warning : result.warnings) std::cerr << "warning: " << warning << "\n";
    if (common_.quiet) return kDone;
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
    tell_names(result.files);
    return kDone;
  }

  static void tell(const Plan& plan, const Export& result) {
    if (result.loss) print_loss(std::cout, plan, *result.loss);
    tell_names(result.files);
  }

  static void tell_names(const std::vector<ExportFile>& files) {
    std::cout << "written: " << text_of_list(files, &ExportFile::name) << "\n";
  }

  MissionSource source_{};
  std::string format_{};
  std::string out_{};
  std::optional<double> rate_Hz_{};
  double corner_radius_m_{};
  bool expand_turns_{};
  PlanOptions options_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_export_command() { return std::make_unique<ExportCommand>(); }

}  // namespace joulepath
