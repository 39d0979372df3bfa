#include <algorithm>
#include <filesystem>
#include <iterator>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/jobs/job_results.hpp"
#include "app/jobs/mission_planner.hpp"
#include "app/plan/plan_options.hpp"
#include "app/program_parts.hpp"
#include "model/printable.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

std::string batch_examples() {
  std::string text =
      "  joulepath batch scenarios/missions --out out/batch -j 2\n"
      "  joulepath batch missions.jsonl --out out/batch --resume\n"
      "  joulepath batch night/*.yaml --out out/night\n";
  for (const auto& part : made(extension_parts().job_parts)) text += example_line("batch", part->example());
  return text +
         "\nEvery mission has a line in results.jsonl; its .status has the outcome. Exit code 1: the "
         "input of some cannot be read; .message says why.\n";
}

/// "missions.jsonl", or "monday.yaml and 3 other files".
std::string title_of(const std::vector<std::string>& sources) {
  const std::string first = printable(std::filesystem::path(sources.front()).filename().string());
  return sources.size() == 1 ? first : first + " and " + counted(sources.size() - 1, "other file");
}

class BatchCommand : public Command {
 public:
  BatchCommand() : Command({.name = "batch", .says = "plan many missions", .examples = batch_examples()}) {}

  void declare(CommandLine& line) override {
    line.option("missions", sources_,
                "directories of missions (*.yaml), missions, or files of JSON lines with the mission's keys")
        .required()
        .existing_path();
    add_job_options(line, options_, "results.jsonl, timings.jsonl, report.html");
    add_plan_options(line, plan_);
    add_confidence(line, confidence_);
    line.flag("--path-bound", plan_.path_bound,
              "bound the energy over all paths, a key of each line (takes longer)");
    line.flag("--baselines", plan_.baselines, "compare every mission with trapezoids (takes longer)");
  }

  int run() override {
    const JobRun run = job_run(options_, text().name, sources_, "missions");
    std::vector<MissionItem> items = mission_items(sources_);
    OutputDirectory out = job_output(options_, run, kBatchFiles);
    plan_.solver = SolverChoice::fast;
    MissionJobs jobs(std::move(items), plan_, {.untrusted = options_.common.untrusted}, options_.cache,
                     confidence_);
    const auto results = run_job_list(jobs, run);
    if (!results) return kInterrupted;
    const std::string title = title_of(sources_);
    int code = kDone;
    if (run.part) {
      run.part->write(out, jobs, *results, run, {.title = title});
    } else {
      add_timings(out, *results);
      code = finish_batch(out, title, lines_of(*results), options_.common);
    }
    remove_journal(run.directory);
    return code;
  }

 private:
  std::vector<std::string> sources_{};
  JobOptions options_{};
  std::optional<double> confidence_{};
  PlanOptions plan_{.baselines = false};
};

}  // namespace

std::unique_ptr<Command> make_batch_command() { return std::make_unique<BatchCommand>(); }

}  // namespace joulepath
