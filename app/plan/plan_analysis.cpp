#include "app/plan/plan_analysis.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"

namespace joulepath {

void add_analysis_options(CommandLine& line, AnalysisOptions& options, const std::string& result_file,
                          bool with_time) {
  add_mission_source(line, options.source, with_time);
  line.option("--out", options.out, "directory for " + result_file + " and report.html");
  add_common_flags(line, options.common, "qjfu");
}

bool writes_analysis(const AnalysisOptions& options) { return !options.out.empty(); }

OutputDirectory analysis_output(const AnalysisOptions& options, const std::string& result_file) {
  if (!writes_analysis(options)) return {".", {}, options.common.force};
  return {options.out, {result_file, "report.html"}, options.common.force};
}

void print_analysis_place(const AnalysisOptions& options) {
  if (writes_analysis(options)) std::cout << "results in " << options.out << "\n";
}

void write_analysis(OutputDirectory& out, const std::string& result_file, const nlohmann::json& result,
                    std::string report_html) {
  out.write(result_file, result.dump(2) + "\n");
  out.write("report.html", std::move(report_html));
  out.commit();
}

nlohmann::json baseline_json(const BaselineTotal& total) {
  const auto driven = [&](double value) {
    return total.feasible ? nlohmann::json(value) : nlohmann::json(nullptr);
  };
  nlohmann::json json{{"name", total.name},
                      {"feasible", total.feasible},
                      {"reason", total.reason},
                      {"energy_J", driven(total.energy_J)},
                      {"motion_energy_J", driven(total.motion_energy_J)},
                      {"duration_s", driven(total.duration_s)},
                      {"optimum_J", driven(total.optimum_J)},
                      {"optimum_motion_J", driven(total.optimum_motion_J)}};
  if (total.feasible && total.late()) json["later_s"] = total.later_s;
  return json;
}

bool prints_analysis_table(const AnalysisOptions& options, const nlohmann::json& result) {
  if (options.common.json) std::cout << result.dump(2) << "\n";
  return !options.common.json && !options.common.quiet;
}

}  // namespace joulepath
