#include "extensions/studies/commands/sweep_output.hpp"

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "extensions/studies/commands/sweep_result.hpp"
#include "extensions/studies/modules.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/counted.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

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

std::string title_of(const Study& study) {
  return study.name.empty() ? printable(std::filesystem::path(study.file).stem().string()) : study.name;
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
      page["cloud"].push_back({totals[k].sums.at("duration_s"), totals[k].sums.at("energy_J"),
                               totals[k].is_within(), totals[k].values});
  out.write("report.html", report::page_html("sweep", {{"sweep", page}, {"title", title_of(study)}},
                                             report::kStudiesModules, "studies/sweep.js"));
  out.commit();
  if (common.json) {
    std::cout << text;
  } else if (!common.quiet) {
    print_sweep(json);
    std::cout << "results in " << out.path() << "\n";
  }
}

}  // namespace joulepath
