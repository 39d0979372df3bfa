#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/commands/batch_journal.hpp"
#include "app/commands/batch_run.hpp"
#include "app/interrupt.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "app/progress.hpp"
#include "app/report/report.hpp"
#include "app/terminal.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

class BatchCommand : public Command {
 public:
  std::string name() const override { return "batch"; }
  std::string says() const override { return "plan many missions"; }
  std::string examples() const override {
    return "  joulepath batch scenarios/missions --out out/batch -j 2\n"
           "  joulepath batch missions.jsonl --out out/batch --resume\n\n"
           "Exit code 0: every mission has a line in results.jsonl; its .status has the outcome.\n";
  }

  void declare(CommandLine& line) override {
    line.option("missions", source_,
                "directory of missions (*.yaml), or a file of JSON lines with the mission's keys")
        .required()
        .existing_path();
    line.option("--out", out_, "directory for results.jsonl, timings.jsonl, report.html").required();
    line.option("-j,--jobs", jobs_, "number of missions planned in parallel").between(1, 256).shows_default();
    add_plan_options(line, options_);
    line.flag("--baselines", options_.baselines,
              "compare every mission with trapezoids (takes twice the time)");
    line.flag("--resume", resume_, "continue an interrupted batch: finished and unchanged missions are kept");
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    const std::vector<BatchItem> items = batch_items(source_);
    OutputDirectory out(out_, {"results.jsonl", "timings.jsonl", "report.html"}, common_.force || resume_);
    const std::string partial = out_ + "/results.partial.jsonl";
    if (std::filesystem::exists(partial) && !resume_ && !common_.force)
      throw ConfigError({{partial, 0, 0},
                         "",
                         "the results of an unfinished batch",
                         "--resume, which continues it",
                         "--force deletes them and starts again"});
    std::filesystem::create_directories(out_);
    options_.solver = SolverChoice::fast;
    BatchPlanner planner(options_, {.untrusted = common_.untrusted});
    BatchJournal journal(partial, resume_ ? BatchJournal::Use::resume : BatchJournal::Use::anew);
    lines_.resize(items.size());
    seconds_.resize(items.size());
    std::vector<std::string> fingerprints;
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < items.size(); ++k) {
      fingerprints.push_back(planner.fingerprint(items[k]));
      if (const BatchResult* earlier = journal.find(k, fingerprints[k])) {
        lines_[k] = earlier->line;
        seconds_[k] = earlier->seconds;
      } else {
        open.push_back(k);
      }
    }
    const PoliteInterrupt interrupt;
    {
      Progress progress("missions", open.size(), common_.quiet);
      run_batch(
          open, jobs_, [&](std::size_t k) { return planner.plan(items[k], k); },
          [&](const BatchResult& result) {
            journal.add(result, fingerprints[result.index]);
            lines_[result.index] = result.line;
            seconds_[result.index] = result.seconds;
            progress.advance();
          },
          [] { return PoliteInterrupt::requested(); });
    }
    if (PoliteInterrupt::requested()) {
      std::cerr << "interrupted; --resume continues\n";
      return kInterrupted;
    }
    finish(out);
    journal.remove();
    return kDone;
  }

 private:
  void finish(OutputDirectory& out) {
    std::string results, timings;
    Json missions = Json::array();
    std::map<std::string, int> count;
    double energy_J = 0.0;
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      results += lines_[k] + "\n";
      missions.push_back(Json::parse(lines_[k]));
      timings += Json{{"index", k}, {"seconds", seconds_[k]}}.dump() + "\n";
      ++count[missions.back()["status"].get<std::string>()];
      energy_J += missions.back().value("energy_J", 0.0);
    }
    out.write("results.jsonl", results);
    out.write("timings.jsonl", timings);
    const std::string title = std::filesystem::path(source_).filename().string();
    out.write("report.html",
              report::batch_report_html(nlohmann::json::parse(Json{{"missions", missions}}.dump()), title));
    out.commit();
    if (common_.json)
      std::cout << results;
    else if (!common_.quiet) {
      std::cout << lines_.size() << " missions:";
      for (const auto& [status, number] : count) std::cout << " " << number << " " << status;
      std::cout << ", " << figure(energy_J, 6) << " J in all\nresults in " << out.path() << "\n";
    }
  }

  std::string source_{};
  std::string out_{};
  unsigned jobs_{std::max(1u, std::thread::hardware_concurrency())};
  bool resume_{};
  PlanOptions options_{.baselines = false};
  CommonOptions common_{};
  std::vector<std::string> lines_{};
  std::vector<double> seconds_{};
};

}  // namespace

std::unique_ptr<Command> make_batch_command() { return std::make_unique<BatchCommand>(); }

}  // namespace joulepath
