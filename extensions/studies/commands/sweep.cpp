#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/command_line.hpp"
#include "app/jobs/job_results.hpp"
#include "app/output_directory.hpp"
#include "app/plan/plan_options.hpp"
#include "extensions/studies/commands/sweep_jobs.hpp"
#include "extensions/studies/commands/sweep_output.hpp"
#include "extensions/studies/commands/sweep_result.hpp"
#include "extensions/studies/sweep/design_search.hpp"
#include "model/number_text.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kMostSearched = 1000;
constexpr std::size_t kManyDesigns = 10'000;  ///< hours on one core

class SweepCommand : public Command {
 public:
  SweepCommand()
      : Command({.name = "sweep",
                 .says = "plan missions with many designs of a robot and compare them",
                 .examples = "  joulepath sweep scenarios/studies/gear_and_speed.yaml --out out/sweep -j 2\n"
                             "  joulepath sweep study.yaml --out out/sweep --optimize 100\n"
                             "  joulepath sweep study.yaml --out shard_2 --shard 2/8   # then: joulepath "
                             "merge shard_* --out "
                             "out/sweep\n\n"
                             "Exit code 0: every design has its rows in sweep.csv, with a reason where it "
                             "has no plan.\n"}) {}

  void declare(CommandLine& line) override {
    line.option("study", source_, "study file (YAML)").required().existing_path();
    add_job_options(line, options_, "sweep.csv, sweep.json, report.html");
    line.option("--optimize", evaluations_,
                "search for a better design near the sweep's best with at most this many further designs; "
                "ranges only")
        .between(0, static_cast<int>(kMostSearched))
        .shows_default();
    add_plan_options(line, plan_);
    line.flag("--path-bound", plan_.path_bound,
              "bound the energy over all paths, a column of sweep.csv (takes longer)");
  }

  int run() override {
    const Study study = read_study(source_, {.untrusted = options_.common.untrusted});
    const JobRun run = job_run(options_, text().name, {source_}, "plans");
    if (evaluations_ > 0 && run.part)
      throw UsageError("--optimize: found together with --shard, accepted: a sweep without shards");
    if (evaluations_ > 0 && std::ranges::none_of(study.designs.parameters(), &SweepParameter::has_ends))
      throw ConfigError({{study.file, 0, 0},
                         "parameters",
                         "lists of values alone, with --optimize",
                         "a parameter with from and to, which --optimize can move"});
    OutputDirectory out = job_output(options_, run, kSweepFiles);
    plan_.solver = SolverChoice::fast;
    if (!options_.common.quiet) tell_size(study);
    SweepJobs jobs(study, plan_, {.untrusted = options_.common.untrusted}, options_.cache);
    const auto results = run_job_list(jobs, run);
    if (!results) return kInterrupted;
    if (run.part) {
      run.part->write(out, jobs, *results, run,
                      {.title = title_of(study), .study_file = study.file, .study_text = study.text});
    } else {
      const std::vector<std::string> lines = lines_of(*results);
      const std::vector<std::string> optimized =
          evaluations_ > 0 ? search(study, jobs, lines) : std::vector<std::string>{};
      add_timings(out, *results);
      finish_sweep(out, study, lines, optimized, options_.common);
    }
    remove_journal(run.directory);
    return kDone;
  }

 private:
  /// A large grid takes days: said before, not by its progress.
  static void tell_size(const Study& study) {
    if (study.designs.size() < kManyDesigns) return;
    std::cerr
        << "note: " << study.designs.size()
        << " designs take hours or days; `sampling: {method: latin_hypercube, designs: 1000}` in the study "
           "draws fewer\n";
  }

  /// The result lines of the best design that the search finds; none if no design of the sweep has a plan
  /// within the constraints.
  std::vector<std::string> search(const Study& study, SweepJobs& jobs,
                                  const std::vector<std::string>& lines) const {
    const auto& parameters = study.designs.parameters();
    std::vector<std::size_t> ranges;
    for (std::size_t p = 0; p < parameters.size(); ++p)
      if (parameters[p].has_ends()) ranges.push_back(p);
    const std::vector<DesignTotal> totals = design_totals(study, lines);
    const auto best = std::ranges::min_element(totals, {}, [](const DesignTotal& total) {
      return std::tuple(!total.is_within(), total.objectives[0]);
    });
    if (best == totals.end() || !best->is_within()) {
      std::cerr << "--optimize: no design is within the constraints, so that there is none to start from\n";
      return {};
    }
    std::vector<double> start;
    for (const std::size_t p : ranges)
      start.push_back(parameters[p].fraction_of(*parse_number(best->values[p])));
    const auto design_at = [&](const std::vector<double>& fractions) {
      std::vector<std::string> design = best->values;
      for (std::size_t i = 0; i < ranges.size(); ++i)
        design[ranges[i]] = number_text(parameters[ranges[i]].at(fractions[i]));
      return design;
    };
    const auto total_of = [&](const std::vector<double>& fractions) {
      return design_totals(study, lines_of(jobs.plan_design(design_at(fractions), study.designs.size())))
          .front();
    };
    const DesignSearch found =
        search_design(start, evaluations_, 1e-3, [&](const std::vector<double>& fractions) {
          const DesignTotal total = total_of(fractions);
          return DesignValue{total.planned, total.objectives[0], total.excess};
        });
    // The start is rounded on its way through fractions: a plan with other ways may take more.
    const bool is_better =
        found.value.planned && found.value.excess <= 0.0 && found.value.objective < best->objectives[0];
    return lines_of(jobs.plan_design(is_better ? design_at(found.best) : best->values, study.designs.size()));
  }

  std::string source_{};
  std::size_t evaluations_{};
  JobOptions options_{};
  PlanOptions plan_{.baselines = false};
};

}  // namespace

std::unique_ptr<Command> make_sweep_command() { return std::make_unique<SweepCommand>(); }

}  // namespace joulepath
