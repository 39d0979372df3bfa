#include "app/jobs/job_results.hpp"

#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

OutputDirectory job_output(const JobOptions& options, const JobRun& run,
                           const std::vector<std::string>& files) {
  // A whole run that is finished may be another one's; a task of a cluster may run its finished shard again.
  const bool continues = options.resume && (run.part || std::filesystem::exists(journal_file(options.out)));
  return {options.out, run.part ? run.part->files() : files, options.common.force || continues};
}

std::vector<std::string> lines_of(const std::vector<JobResult>& results) {
  std::vector<std::string> lines;
  lines.reserve(results.size());
  for (const JobResult& result : results) lines.push_back(result.line);
  return lines;
}

void add_timings(OutputDirectory& out, const std::vector<JobResult>& results) {
  std::string timings;
  for (const JobResult& result : results)
    timings += Json{{"index", result.index}, {"seconds", result.seconds}}.dump() + "\n";
  out.write("timings.jsonl", timings);
}

void finish_batch(OutputDirectory& out, const std::string& title, const std::vector<std::string>& lines,
                  const CommonOptions& common) {
  const std::string results = joined(lines);
  nlohmann::json missions = nlohmann::json::array();
  std::map<std::string, int> count;
  double energy_J = 0.0;
  for (const std::string& line : lines) {
    missions.push_back(nlohmann::json::parse(line));
    ++count[missions.back()["status"].get<std::string>()];
    energy_J += missions.back().value("energy_J", 0.0);
  }
  out.write("results.jsonl", results);
  out.write("report.html", report::batch_report_html({{"missions", std::move(missions)}}, title));
  out.commit();
  if (common.json) {
    std::cout << results;
  } else if (!common.quiet) {
    std::cout << counted(lines.size(), "mission") << ":";
    for (const auto& [status, number] : count)
      std::cout << " " << number << " " << status << (status == "optimal" ? " on their paths" : "");
    std::cout << ", " << figure(energy_J, 6) << " J in all\nresults in " << out.path() << "\n";
  }
}

}  // namespace joulepath
