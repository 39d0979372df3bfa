#include "app/jobs/job_results.hpp"

#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/build_id.hpp"
#include "app/jobs/content_hash.hpp"
#include "app/jobs/sweep_result.hpp"
#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/counted.hpp"
#include "scenarios/significant.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string design_text(const Json& total) {
  std::string text;
  for (const auto& [name, value] : total["parameters"].items())
    append_item(
        text,
        name + " " + (value.is_string() ? value.get<std::string>() : significant_text(value.get<double>())));
  return printable(text) + ": " + figure(total["energy_J"].get<double>(), 6) + " J, " +
         figure(total["duration_s"].get<double>(), 5) + " s";
}

void print_sweep(const Json& json) {
  std::cout << counted(json["designs"], "design") << ": " << json["planned"] << " planned, "
            << json["within_constraints"] << " within the constraints\n";
  for (const auto& [reason, count] : json["not_counted"].items())
    std::cout << "  " << count << " " << reason << "\n";
  for (const auto& held : json["held_constant"])
    std::cout << "held constant: " << held.get<std::string>() << "\n";
  if (json.contains("best")) std::cout << "best design: " << design_text(json["best"]) << "\n";
  if (json.contains("optimized")) std::cout << "optimized: " << design_text(json["optimized"]) << "\n";
  if (json["planned"] == 0) return;  // no energies to compare
  Table table({"parameter", "share of the variance of energy", "levels: mean J"});
  for (const auto& effect : json["effects"]["energy_J"]["main"]) {
    const std::string levels = text_of_list(effect["levels"], [](const auto& level) {
      return level["level"].template get<std::string>() + ": " +
             figure(level["mean"].template get<double>(), 5);
    });
    table.row(
        {effect["parameter"], figure(100.0 * effect["share_of_variance"].get<double>(), 3) + " %", levels});
  }
  table.print(std::cout);
}

}  // namespace

OutputDirectory job_output(const JobOptions& options, const Shard& shard,
                           const std::vector<std::string>& files) {
  // A whole run that is finished may be another one's; a task of a cluster may run its finished shard again.
  const bool continues =
      options.resume && (!shard.is_whole() || std::filesystem::exists(journal_file(options.out)));
  return {options.out, shard.is_whole() ? files : kShardFiles, options.common.force || continues};
}

std::vector<std::string> lines_of(const std::vector<JobResult>& results) {
  std::vector<std::string> lines;
  lines.reserve(results.size());
  for (const JobResult& result : results) lines.push_back(result.line);
  return lines;
}

std::string title_of(const Study& study) {
  return study.name.empty() ? printable(std::filesystem::path(study.file).stem().string()) : study.name;
}

void add_timings(OutputDirectory& out, const std::vector<JobResult>& results) {
  std::string timings;
  for (const JobResult& result : results)
    timings += Json{{"index", result.index}, {"seconds", result.seconds}}.dump() + "\n";
  out.write("timings.jsonl", timings);
}

void write_shard(OutputDirectory& out, const JobList& jobs, const std::vector<JobResult>& results,
                 ShardManifest about) {
  about.version = JOULEPATH_VERSION;
  about.build = kBuildId;
  about.options = jobs.options();
  about.jobs = jobs.size();
  about.list_digest = jobs.digest();
  about.files = jobs.files_read();
  const std::string lines = joined(lines_of(results));
  about.results_digest = ContentHash().mix(lines).text();
  out.write("results.jsonl", lines);
  add_timings(out, results);
  out.write("shard.json", manifest_text(about));
  out.commit();
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

void finish_sweep(OutputDirectory& out, const Study& study, const std::vector<std::string>& lines,
                  const std::vector<std::string>& optimized, const CommonOptions& common) {
  const std::vector<DesignTotal> totals = design_totals(study, lines);
  const Json json = sweep_json(study, lines, totals, optimized);
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  out.write("sweep.csv", sweep_csv(study, lines));
  out.write("sweep.json", text);
  nlohmann::json page = nlohmann::json::parse(text);
  page["cloud"] = nlohmann::json::array();
  const std::size_t stride = 1 + totals.size() / 2000;  // dots of the plot
  for (std::size_t k = 0; k < totals.size(); k += stride)
    if (totals[k].planned)
      page["cloud"].push_back(
          {totals[k].sums.at("duration_s"), totals[k].sums.at("energy_J"), totals[k].is_within()});
  out.write("report.html", report::sweep_report_html(page, title_of(study)));
  out.commit();
  if (common.json) {
    std::cout << text;
  } else if (!common.quiet) {
    print_sweep(json);
    std::cout << "results in " << out.path() << "\n";
  }
}

}  // namespace joulepath
