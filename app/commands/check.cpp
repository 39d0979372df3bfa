#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "model/printable.hpp"
#include "model/progress.hpp"
#include "planner/mission/mission.hpp"
#include "planner/values/verdict_text.hpp"
#include "planner/ways/leg_path.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/repaired_dataset.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

/// A text of several lines, safe for a terminal.
std::string printable_text(const std::string& text) {
  std::string lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines += printable(line) + "\n";
  return lines;
}

nlohmann::ordered_json error_json(const ConfigError& error) {
  const auto& d = error.detail();
  return {{"file", d.mark.file}, {"line", d.mark.line},    {"column", d.mark.column},
          {"key", d.key},        {"found", d.found},       {"accepted", d.accepted},
          {"hint", d.hint},      {"message", error.what()}};
}

void tell_error(const ConfigError& error) {
  std::cerr << paint(std::cerr, Paint::error, "joulepath: ") << printable(error.what()) << '\n';
}

bool is_sound(const FileSummary& summary) {
  return summary.data_checks.empty() && summary.errors.empty() && summary.question.empty();
}

/// What a coarse plan of a mission runs into: a place that no way leads to, a deadline that is too early. Its
/// paths are not refined, so a plan may arrive a little earlier. Throws ConfigError where the robot does not
/// fit at the start or at a stop.
std::string coarse_verdict(const std::string& file, const ReadOptions& reading) {
  MissionRequest mission = read_mission(file, reading);
  mission.objective.confidence.reset();
  const MissionWorld world = read_world(mission, reading);
  if (!world.robot.limits) return "";
  const std::optional<RouteSpace> space = route_space(mission, world);
  if (space) refuse_blocked_goals(mission, *space);
  const Plan plan = plan_mission(mission, world,
                                 {.solver = SolverChoice::fast,
                                  .nodes = 40,
                                  .steps = {.refinement = false},
                                  .baselines = false,
                                  .draft = true},
                                 space ? &*space : nullptr);
  if (!plan.infeasibility) return "";
  const auto& [reason, leg, to, arc_length_m, state] = *plan.infeasibility;
  return "tried coarsely: " + reason.constraint + " on leg " + leg_text(leg, to) + ": " + plan.message;
}

class Check : public Command {
 public:
  Check()
      : Command({.name = "check",
                 .says = "validate input files and report errors",
                 .examples = "  joulepath check scenarios/missions/warehouse_pick.yaml\n"
                             "  joulepath check robot.yaml dataset.yaml runs/run_01.csv\n"
                             "  joulepath check --kind robot my_robot.yaml\n"
                             "  joulepath check dataset.yaml --repair dataset_repaired.yaml"}) {}

  void declare(CommandLine& line) override {
    line.option("FILE", files_, checked_kinds()).required();
    line.option("--kind", kind_, "kind of the files; default: from their schema line, name and keys");
    line.option("--repair", repair_, "write the dataset with its suspect channels repaired to this file");
    line.flag(
        "--brief", brief_,
        "do not try a mission coarsely; check the data of a dataset only, not which effects its runs tell "
        "apart");
    add_common_flags(line, options_, "qjfu");
  }

  int run() override {
    int code = kDone;
    auto results = nlohmann::ordered_json::array();
    expect_steps(files_.size());
    for (const auto& file : files_) {
      try {
        const StepScope one_step(nullptr);
        FileSummary summary = read_any_file(file, kind_, {options_.untrusted}, brief_);
        if (summary.kind == "mission" && !brief_)
          if (std::string verdict = coarse_verdict(file, {options_.untrusted}); !verdict.empty())
            summary.notes.push_back(std::move(verdict));
        results.push_back(summary_json(file, summary));
        if (!options_.json) tell(file, summary);
        if (!is_sound(summary) && code == kDone) code = kInfeasibleOrFailed;
        if (!repair_.empty()) write_repaired(file, summary);
      } catch (const ConfigError& error) {
        code = kBadInput;
        results.push_back({{"file", file}, {"ok", false}, {"error", error_json(error)}});
        if (!options_.json) tell_error(error);
      }
      finish_steps();
    }
    if (!options_.quiet && !options_.json) print_whole_lines(std::cout, printable_text(proposed()));
    if (options_.json)
      std::cout << results.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return code;
  }

 private:
  nlohmann::ordered_json summary_json(const std::string& file, const FileSummary& summary) const {
    nlohmann::ordered_json result{{"file", file},
                                  {"ok", is_sound(summary)},
                                  {"kind", summary.kind},
                                  {"summary", summary.text},
                                  {"notes", summary.notes}};
    if (summary.kind == "dataset") {
      result["data_checks"] = data_checks_json(summary.data_checks);
      if (!brief_) result["isolability"] = isolability_json(summary.isolability);
    }
    if (!summary.question.empty()) result["question"] = summary.question;
    for (const ConfigError& error : summary.errors) result["errors"].push_back(error_json(error));
    if (!summary.proposal.empty()) result["proposal"] = summary.proposal;
    return result;
  }

  void write_repaired(const std::string& file, const FileSummary& summary) const {
    if (summary.kind != "dataset" || files_.size() != 1)
      throw ConfigError({{file, 0, 0}, "--repair", "no single dataset", "one dataset file", ""});
    const Dataset dataset = read_dataset(
        file, {.untrusted = options_.untrusted, .cut_long_logs = true, .accept_implausible = true});
    const std::string directory = std::filesystem::absolute(repair_).parent_path().string();
    write_output_file(repair_, repaired_dataset_text(dataset, summary.data_checks, directory),
                      options_.force);
  }

  /// One dataset file for all logs with the columns of the first.
  void propose(const std::string& file, const FileSummary& summary) {
    static constexpr std::string_view kRuns = "\nruns:\n";
    const auto begin_of_runs = summary.proposal.find(kRuns) + kRuns.size();
    const std::string head = summary.proposal.substr(0, begin_of_runs);
    if (proposed_runs_.empty()) proposed_head_ = head;
    if (proposed_head_ == head)
      proposed_runs_.emplace_back(summary.proposal.substr(begin_of_runs), summary.begins_s);
    else
      std::cerr
          << "  note: the topics of " << printable(file)
          << " differ from those of the first file: its dataset file is proposed by a check of it alone\n";
  }

  /// Runs of one day count their time from the first one's first stamp: heating needs it.
  [[nodiscard]] std::string proposed() const {
    std::string text = proposed_head_;
    double first_s = 0;
    for (const auto& [run, begins_s] : proposed_runs_)
      if (begins_s > 0 && (first_s == 0 || begins_s < first_s)) first_s = begins_s;
    for (const auto& [run, begins_s] : proposed_runs_) {
      text += run;
      if (proposed_runs_.size() > 1 && begins_s > 0)
        text += "    start_time_s: " + significant_text(std::round(begins_s - first_s)) + "\n";
    }
    return text;
  }

  /// Where a file is proposed, the status goes to standard error.
  void tell(const std::string& file, const FileSummary& summary) {
    const bool sound = is_sound(summary);
    std::ostream& out = summary.proposes ? std::cerr : std::cout;
    out << printable(file) << ": "
        << paint(out, sound ? Paint::good : Paint::error,
                 sound                    ? "ok"
                 : summary.errors.empty() ? "suspect"
                                          : "broken")
        << " (" << summary.kind << (summary.text.empty() ? "" : ": " + printable(summary.text)) << ")\n";
    if (!summary.question.empty()) std::cout << "  " << printable(summary.question) << '\n';
    for (const DataCheck& check : summary.data_checks)
      std::cout << "  " << printable(data_check_text(check)) << '\n';
    for (const ConfigError& error : summary.errors) tell_error(error);
    if (!options_.quiet)
      for (const auto& note : summary.notes) std::cerr << "  note: " << printable(note) << '\n';
    if (!summary.proposal.empty()) propose(file, summary);
  }

  std::vector<std::string> files_{};
  std::string kind_{};
  std::string repair_{};
  std::string proposed_head_{};
  std::vector<std::pair<std::string, double>> proposed_runs_{};  ///< with the stamp of their first message
  bool brief_{};
  CommonOptions options_{};
};

}  // namespace

std::unique_ptr<Command> make_check_command() { return std::make_unique<Check>(); }

}  // namespace joulepath
