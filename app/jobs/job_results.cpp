#include "app/jobs/job_results.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "model/printable.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kReasons = 5;  ///< that are printed

/// Whether a line has no verdict on its mission: bad_input, environment_error, internal_error.
bool has_failed(const nlohmann::json& line) {
  const std::string status = line["status"];
  return status == "bad_input" || status.ends_with("_error");
}

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

int finish_batch(OutputDirectory& out, const std::string& title, const std::vector<std::string>& lines,
                 const CommonOptions& common) {
  const std::string results = joined(lines);
  nlohmann::json missions = nlohmann::json::array();
  std::map<std::string, int> count;
  std::vector<std::string> failed;
  double energy_J = 0.0;
  for (const std::string& line : lines) {
    missions.push_back(nlohmann::json::parse(line));
    ++count[missions.back()["status"].get<std::string>()];
    energy_J += missions.back().value("energy_J", 0.0);
    if (has_failed(missions.back())) failed.push_back(missions.back().value("message", ""));
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
  for (std::size_t k = 0; k < std::min(failed.size(), kReasons); ++k)
    std::cerr << "joulepath: " << printable(failed[k]) << "\n";
  if (failed.size() > kReasons)
    std::cerr << "joulepath: " << failed.size() - kReasons << " more in results.jsonl (status, message)\n";
  return failed.empty() ? kDone : kInfeasibleOrFailed;
}

}  // namespace joulepath
