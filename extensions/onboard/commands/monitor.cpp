#include "extensions/onboard/monitor/monitor.hpp"

#include <fstream>
#include <iostream>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "extensions/onboard/log_stream.hpp"
#include "extensions/onboard/planned_course_file.hpp"
#include "extensions/onboard/write_monitor_event.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

class MonitorCommand : public Command {
 public:
  MonitorCommand()
      : Command({.name = "monitor",
                 .says = "compare a drive with its plan while the robot drives: energy, payload, battery",
                 .examples = "  joulepath monitor out/warehouse_pick day.csv --robot robot.yaml\n"
                             "  tail -f run.jsonl | joulepath monitor out/warehouse_pick - --robot "
                             "robot.yaml --json\n"}) {}

  void declare(CommandLine& line) override {
    line.option("plan", directory_, "directory of a plan (trajectory.csv, plan.json)").required();
    line.option("log", log_, "CSV or JSON lines, read as they grow; - for standard input; MCAP as a whole")
        .required();
    line.option("--robot", robot_, "robot file").required();
    line.option("--false-alarm-hours", options_.hours_per_false_alarm,
                "mean time between false alarms in hours, at least")
        .between(0.1, 1e6)
        .shows_default();
    line.option("--status-s", options_.status_every_s, "seconds between two lines of status")
        .between(0.1, 1e6)
        .shows_default();
    add_common_flags(line, common_, "qj");
  }

  int run() override {
    const Robot robot = read_robot(robot_);
    Monitor monitor(robot, read_planned_course(directory_, robot), options_);
    if (log_ == "-") {
      follow(monitor, robot, std::cin);
    } else if (log_reader_of(log_)) {
      const RunLog log = read_run_log(log_, robot.geometry);
      for (std::size_t k = 0; k < log.trajectory.size(); ++k) add(monitor, monitor_row(log.trajectory, k));
    } else {
      std::ifstream file(log_);
      if (!file) throw ConfigError({{log_, 0, 0}, "", "no such file", "a log, or - for standard input", ""});
      follow(monitor, robot, file);
    }
    refuse(monitor.judge_end());
    const RowCounts rows = monitor.status().rows;
    if (rows.used == 1 && rows.late > 0)
      throw ConfigError(
          {{log_name(), 0, 0}, "time_s", "no two rows on one clock", "a clock in seconds", kClockHint});
    if (rows.used == 0)
      throw ConfigError(
          {{log_name(), 0, 0}, "", "no row with a time and speeds", "a log of the plan's drive", ""});
    tell({monitor.leg_executed(), monitor.status()});
    if (!common_.json && !common_.quiet) std::cout << row_counts_text(monitor.status().rows) << std::endl;
    return other_cause_ ? kInfeasibleOrFailed : kDone;
  }

 private:
  std::string log_name() const { return log_ == "-" ? "standard input" : log_; }

  void follow(Monitor& monitor, const Robot& robot, std::istream& stream) {
    LogLines(robot.geometry, log_name()).follow(stream, [&](const MonitorRow& row) { add(monitor, row); });
  }

  /// A log whose channels are wrong ends the answer: nothing that it says is true.
  void refuse(const std::optional<Implausible>& odd) const {
    if (odd) throw ConfigError({{log_name(), 0, 0}, odd->channel, odd->found, odd->accepted, odd->hint});
  }

  void add(Monitor& monitor, const MonitorRow& row) {
    const std::vector<MonitorEvent>& events = monitor.add(row);
    refuse(monitor.implausible());
    tell(events);
  }

  void tell(const std::vector<MonitorEvent>& events) {
    for (const MonitorEvent& event : events) {
      other_cause_ = other_cause_ || std::holds_alternative<NotPayload>(event);
      if (common_.json)
        std::cout << monitor_json(event) << std::endl;
      else if (!common_.quiet || !std::holds_alternative<MonitorStatus>(event))
        std::cout << monitor_text(event) << std::endl;
    }
  }

  std::string directory_{};
  std::string log_{};
  std::string robot_{};
  MonitorOptions options_{};
  CommonOptions common_{};
  bool other_cause_{};
};

}  // namespace

std::unique_ptr<Command> make_monitor_command() { return std::make_unique<MonitorCommand>(); }

}  // namespace joulepath
