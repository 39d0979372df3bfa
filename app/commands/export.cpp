#include <filesystem>
#include <iostream>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/export_task.hpp"
#include "app/plan/loss_table.hpp"
#include "app/plan/plan_options.hpp"
#include "app/program_parts.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
// Design: docs/decisions/0603-orders-and-exports.md
namespace joulepath {
namespace {

using ExportTasks = std::vector<std::unique_ptr<ExportTask>>;

const ExportFormat& format_named(const std::string& name) {
  for (const ExportFormat& format : export_formats())
    if (format.name == name) return format;
  throw UsageError("no format '" + name + "'");
}

std::string examples(const ExportTasks& tasks) {
  std::string text =
      "  joulepath export mission.yaml --to nav2_path --out path.json\n"
      "  joulepath export path.csv --robot robot.yaml --time 30 --to trajectory --out trajectory.json\n";
  for (const ExportFormat& format : export_formats()) text += example_line("export", format.example);
  for (const auto& task : tasks) text += example_line("export", task->example());
  text += "\nFormats:\n";
  const auto line = [&](const std::string& name, const std::string& says) {
    text += "  " + name + std::string(15 - name.size(), ' ') + says + "\n";
  };
  for (const ExportFormat& format : export_formats()) line(format.name, format.says);
  for (const auto& task : tasks) line(task->name(), task->says());
  return text;
}

class ExportCommand : public Command {
 public:
  explicit ExportCommand(ExportTasks tasks)
      : Command({.name = "export",
                 .says = "plan a mission, or take a log, and write it in the format of another program",
                 .examples = examples(tasks)}),
        tasks_(std::move(tasks)) {}

  void declare(CommandLine& line) override {
    std::vector<std::string> names;
    for (const ExportFormat& format : export_formats()) names.push_back(format.name);
    for (const auto& task : tasks_) names.push_back(task->name());
    add_mission_source(line, arguments_.source);
    line.option("--to", format_, "format").required().one_of(names, "export");
    line.option("--out", arguments_.out, "file to write; further files use its name").required();
    line.option("--rate", rate_Hz_, "samples per second, for formats with samples").between(0.1, 1000.0);
    for (const auto& task : tasks_) task->declare(line);
    add_plan_options(line, options_);
    add_common_flags(line, arguments_.common, "qjfu");
  }

  int run() override {
    for (const auto& task : tasks_)
      if (task->name() == format_) return task->run(arguments_);
    const auto& [source, out, common] = arguments_;
    const ReadOptions reading{.untrusted = common.untrusted};
    const ExportFormat& format = format_named(format_);
    if (format.write_log && is_run_log(source.file)) return write_log(format);
    check_extension();
    const MissionRequest mission = read_told_source(source, reading, arguments_.common.quiet);
    const MissionWorld world = read_told_world(mission, reading, arguments_.common.quiet);
    options_.solver = SolverChoice::fast;
    options_.baselines = false;  // exports do not use the plan's own baselines
    const Plan plan = plan_mission(mission, world, options_);
    if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) {
      std::cerr << "no plan to export: " << solve_status_name(plan.status) << ": " << plan.message << "\n";
      return kInfeasibleOrFailed;
    }
    const Plant plant = make_plant(world.robot);
    const Export result = format.write({mission, world, plan, plant, out, rate_Hz_});
    write_export_files(result.files, common);
    if (common.json && result.loss)
      std::cout << loss_json_text(*result.loss, format_);
    else if (!common.quiet)
      tell(plan, result);
    return kDone;
  }

 private:
  /// A table is written as CSV or JSON, depending on the name's extension.
  void check_extension() const {
    const std::string extension = std::filesystem::path(arguments_.out).extension().string();
    if (format_ == "edges" && extension != ".csv" && extension != ".json")
      throw ConfigError(
          {{arguments_.out, 0, 0}, "", "a name that ends neither with .csv nor .json", "one of them", ""});
  }

  int write_log(const ExportFormat& format) const {
    need_robot(arguments_.source, "a log");
    const Geometry geometry = read_robot(arguments_.source.robot_file).geometry;
    const Trajectory log = read_run_log(arguments_.source.file, geometry).trajectory;
    const std::vector<ExportFile> files{{arguments_.out, format.write_log(log, geometry)}};
    write_export_files(files, arguments_.common);
    if (!arguments_.common.quiet) tell_export_files(files);
    return kDone;
  }

  static void tell(const Plan& plan, const Export& result) {
    if (result.loss) print_loss(std::cout, plan, *result.loss);
    tell_export_files(result.files);
  }

  ExportTasks tasks_;
  ExportArguments arguments_{};
  std::string format_{};
  std::optional<double> rate_Hz_{};
  PlanOptions options_{};
};

}  // namespace

std::unique_ptr<Command> make_export_command() {
  return std::make_unique<ExportCommand>(made(extension_parts().export_tasks));
}

}  // namespace joulepath
