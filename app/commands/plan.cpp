#include <chrono>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/jobs/cache_choice.hpp"
#include "app/jobs/progress.hpp"
#include "app/output_directory.hpp"
#include "app/plan/plan_options.hpp"
#include "app/plan/plan_results.hpp"
#include "app/plan/plan_summary.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string plan_examples() {
  std::string text =
      "  joulepath plan scenarios/missions/warehouse_pick.yaml --out out/warehouse_pick\n"
      "  joulepath plan mission.yaml --out out --json | jq .energy_J\n";
  for (const MissionDocument& document : registry().mission_documents)
    text += example_line("plan", document.example);
  return text + "  joulepath plan path.csv --robot robot.yaml --payload 5 --time 30 --out out\n";
}

/// Whether a directory holds the verdict of an earlier try instead of a plan: the next one may replace it.
bool holds_no_plan(const std::string& directory) {
  std::ifstream file(directory + "/plan.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object()) return false;
  const auto status = json.find("status");
  return status != json.end() && (*status == solve_status_name(SolveStatus::infeasible) ||
                                  *status == solve_status_name(SolveStatus::failed));
}

class PlanCommand : public Command {
 public:
  PlanCommand()
      : Command(
            {.name = "plan", .says = "plan a mission for the least energy", .examples = plan_examples()}) {}

  void declare(CommandLine& line) override {
    add_mission_source(line, source_);
    line.option("--out", out_,
                "directory for plan.json, trajectory.csv, profile.csv, report.html, timing.json")
        .required();
    line.option("--solver", solver_, "ipopt (reference) or fast (built-in; falls back to ipopt)")
        .one_of({"ipopt", "fast"})
        .shows_default();
    add_plan_options(line, options_);
    add_confidence(line, confidence_);
    line.option("--accuracy", options_.accuracy, "relative energy accuracy that ends grid refinement")
        .between(1e-7, 1e-1)
        .shows_default();
    line.option("--without", without_,
                "omit a step of the choice of ways, for comparison: corners (stop, turn, go), routes (the "
                "shortest), stops (turn in place there), refinement (path and speed together); or "
                "baselines, path_bound (several: with commas)")
        .comma_separated()
        .one_of({"corners", "routes", "stops", "refinement", "baselines", "path_bound"});
    line.option("--missions-per-day", operation_.missions_per_day, "report.html shows the energy of a year")
        .positive();
    line.option("--price-per-kWh", operation_.price_per_kWh, "with --missions-per-day: its price, too")
        .not_negative();
    line.option("-j,--jobs", options_.threads, "number of legs planned in parallel")
        .between(1, 256)
        .shows_default();
    line.option("--cache", cache_,
                "directory in which results about legs are cached for later runs; default: no cache on disk");
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    const Clock::time_point start = Clock::now();
    if (operation_.price_per_kWh && !operation_.missions_per_day)
      throw UsageError("--price-per-kWh needs --missions-per-day: the price is that of a year's energy");
    OutputDirectory out(out_, {"plan.json", "trajectory.csv", "profile.csv", "timing.json", "report.html"},
                        common_.force || holds_no_plan(out_));
    const ReadOptions reading{.untrusted = common_.untrusted};
    MissionRequest mission = read_told_source(source_, reading, common_.quiet);
    if (confidence_) mission.objective.confidence = confidence_;
    MissionWorld world = read_told_world(mission, reading, common_.quiet);
    const double reading_s = seconds_since(start);
    for (const std::string& step : without_) leave_out(step);
    options_.solver = solver_ == "fast" ? SolverChoice::fast : SolverChoice::ipopt;
    const std::unique_ptr<AnswerCache> answers = answer_cache({cache_, cache_.empty()});
    // The cache holds this mission only, so that there is one world.
    options_.answers.cache = answers.get();
    if (!cache_.empty()) options_.answers.world = world_key(floor_key(mission, world), world.robot);
    Plan plan = [&] {
      const Waiting waiting("planning", common_.quiet);
      return plan_mission(mission, world, options_);
    }();
    const double planning_s = seconds_since(start) - reading_s;

    const PlanResults results = plan_results(std::move(mission), std::move(world), std::move(plan));
    out.write("plan.json", results.json);
    out.write("timing.json", "{\"reading_s\": " + std::to_string(reading_s) +
                                 ", \"planning_s\": " + std::to_string(planning_s) + "}\n");
    if (results.valid) {
      out.write("trajectory.csv", results.trajectory_text());
      out.write("profile.csv", results.profile_text());
    }
    out.write("report.html", results.report(operation_));
    out.commit();
    if (common_.json)
      std::cout << results.json;
    else if (!common_.quiet)
      print_plan_summary(std::cout, results.plan, out.path());
    else if (!results.valid)
      std::cerr << solve_status_name(results.plan.status) << ": " << results.plan.message << "\n";
    return results.valid ? kDone : kInfeasibleOrFailed;
  }

 private:
  void leave_out(const std::string& step) {
    if (step == "corners") options_.steps.corners = false;
    if (step == "routes") options_.steps.routes = false;
    if (step == "stops") options_.steps.stops = false;
    if (step == "refinement") options_.steps.refinement = false;
    if (step == "baselines") options_.baselines = false;
    if (step == "path_bound") options_.path_bound = false;
  }

  MissionSource source_{};
  std::string out_{};
  report::Operation operation_{};
  std::string solver_{"ipopt"};
  std::string cache_{};
  std::vector<std::string> without_{};
  std::optional<double> confidence_{};
  PlanOptions options_{.path_bound = true};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_plan_command() { return std::make_unique<PlanCommand>(); }

}  // namespace joulepath
