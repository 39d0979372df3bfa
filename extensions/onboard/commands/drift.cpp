#include "extensions/onboard/drift.hpp"

#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/terminal.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

double percent_of(double part, double whole) { return 100 * part / std::abs(whole); }

/// A robot file's values without its name.
std::string values_of(Robot robot) {
  robot.name.clear();
  return robot_text(robot);
}

/// Constants that were calibrated with different robot files differ by the files. Throws ConfigError where
/// the values of `day` are not those of `first`.
void demand_same_robot(const Dataset& first, const Dataset& day) {
  if (values_of(day.robot) == values_of(first.robot)) return;
  throw ConfigError({{day.file, 0, 0},
                     "robot",
                     "\"" + day.robot_file + "\", whose values are not those of \"" + first.robot_file +
                         "\" of " + first.file,
                     "one robot file for all days",
                     "--robot FILE replaces the datasets'"});
}

class DriftCommand : public Command {
 public:
  DriftCommand()
      : Command(
            {.name = "drift",
             .says = "name the constants that changed since the calibrated day",
             .examples =
                 "  joulepath drift days/monday.yaml days/tuesday.yaml days/wednesday.yaml\n"
                 "  joulepath drift calibrated.yaml tonight.yaml --false-alarm-rate 0.001 --json\n\n"
                 "Exit code 0: no drift in the constants that could be compared; 1: a constant of the last "
                 "day differs\nfrom the first day's; 2: cannot tell, as no constant is determined by both "
                 "days (or bad input).\n"}) {}

  void declare(CommandLine& line) override {
    line.option("DAY", days_,
                "datasets or logs, oldest first; the first is the calibrated day. All have one robot file")
        .required();
    line.option("--robot", robot_, "robot file; replaces the datasets'");
    line.option("--false-alarm-rate", settings_.false_alarm_rate,
                "probability of exit code 1 after a day without drift")
        .between(1e-3, 0.5)
        .shows_default();
    add_common_flags(line, common_, "qju");
  }

  int run() override {
    if (days_.size() < 2) throw UsageError("drift needs the calibrated day and at least one day after it");
    std::vector<Dataset> datasets;
    for (const std::string& day : days_) {
      datasets.push_back(read_dataset_or_log(day, {common_.untrusted}, robot_));
      demand_same_robot(datasets.front(), datasets.back());
    }
    std::vector<std::vector<CalibratedParameter>> estimates;
    for (const Dataset& day : datasets)
      estimates.push_back(calibrate(day, CalibrationMethod::full).parameters);
    const DriftResult result = find_drift(estimates, settings_);
    if (common_.json)
      std::cout << json_of(result).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    else if (!common_.quiet)
      print(result);
    if (!result.can_tell()) return kBadInput;
    return result.drifted() ? kInfeasibleOrFailed : kDone;
  }

 private:
  Json json_of(const DriftResult& result) const {
    Json json{{"schema", "joulepath/drift/1"},
              {"days", days_},
              {"false_alarm_rate", settings_.false_alarm_rate},
              {"answer", answer(result)},
              {"drifted", Json::array()},
              {"parameters", Json::array()},
              {"not_compared", Json::array()}};
    for (const NotCompared& c : result.not_compared)
      json["not_compared"].push_back(
          {{"name", c.name}, {"days", names_of(c.days)}, {"why", c.why}, {"needs", c.needs}});
    for (const ParameterDrift& p : result.parameters) {
      if (p.drifted) json["drifted"].push_back(p.name);
      json["parameters"].push_back({{"name", p.name},
                                    {"unit", p.unit},
                                    {"reference", p.reference},
                                    {"value", p.value},
                                    {"change_percent", percent_of(p.value - p.reference, p.reference)},
                                    {"standard_error_percent", percent_of(p.standard_error, p.reference)},
                                    {"since", days_[p.since]},
                                    {"days", p.days},
                                    {"statistic", p.statistic},
                                    {"threshold", p.threshold},
                                    {"detectable_percent", percent_of(p.detectable, p.reference)},
                                    {"drifted", p.drifted}});
    }
    return json;
  }

  static const char* answer(const DriftResult& result) {
    if (!result.can_tell()) return "cannot_tell";
    return result.drifted() ? "drift" : "no_drift";
  }

  void print(const DriftResult& result) const {
    if (result.can_tell())
      print_compared(result);
    else
      std::cout << "cannot tell: no constant is determined by the first and by the last day\n";
    print_not_compared(result);
  }

  /// Constants with the same reason in one line.
  void print_not_compared(const DriftResult& result) const {
    std::map<std::string, std::string> names;  // by the reason
    for (const NotCompared& c : result.not_compared) {
      const std::string days = text_of_list(names_of(c.days), " and ");
      append_item(names[c.why + " (" + days + "); needs " + c.needs], c.name);
    }
    for (const auto& [reason, of] : names)
      (result.can_tell() ? std::cerr : std::cout) << "not compared: " << of << ": " << reason << "\n";
  }

  std::vector<std::string> names_of(const std::vector<std::size_t>& days) const {
    std::vector<std::string> names;
    for (const std::size_t day : days) names.push_back(days_[day]);
    return names;
  }

  void print_compared(const DriftResult& result) const {
    Table table({"constant", "calibrated", "now", "change", "", "would be found", "unit"});
    for (const ParameterDrift& p : result.parameters)
      table.row({p.name, figure(p.reference), figure(p.value),
                 figure(percent_of(p.value - p.reference, p.reference), 3) + " %",
                 p.drifted ? "DRIFTED, most since " + days_[p.since] : "",
                 figure(percent_of(p.detectable, p.reference), 2) + " %", p.unit});
    table.print(std::cout);
    std::cout << (result.drifted() ? "drifted" : "no drift found in these constants")
              << "; a night without drift is reported with " << figure(100 * settings_.false_alarm_rate, 3)
              << " %\nwould be found: a step on the second day, with 80 %\n";
  }

  std::vector<std::string> days_{};
  std::string robot_{};
  DriftSettings settings_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_drift_command() { return std::make_unique<DriftCommand>(); }

}  // namespace joulepath
