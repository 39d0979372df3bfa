#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/command.hpp"
#include "app/output_directory.hpp"
#include "app/plan/plan_options.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Options of the commands that analyze the plans of one mission or path. They print a table, and optionally
/// write one JSON file and report.html.
struct AnalysisOptions {
  MissionSource source{};
  std::string out{};  ///< empty: nothing is written
  PlanOptions plan{.solver = SolverChoice::fast,
                   .baselines = false};  // these commands do not use the plan's own baselines
  CommonOptions common{};
};

/// Adds the input, --out and the common flags.
void add_analysis_options(CommandLine& line, AnalysisOptions& options, const std::string& result_file,
                          bool with_time = true);

/// The output directory. Throws ConfigError if results exist and --force is not given.
[[nodiscard]] OutputDirectory analysis_output(const AnalysisOptions& options, const std::string& result_file);
[[nodiscard]] bool writes_analysis(const AnalysisOptions& options);

/// Says below the tables where the results are, if some were written.
void print_analysis_place(const AnalysisOptions& options);

/// Writes the result and its report.
void write_analysis(OutputDirectory& out, const std::string& result_file, const nlohmann::json& result,
                    std::string report_html);

/// Prints the result under --json. Returns true if the caller must print the table.
[[nodiscard]] bool prints_analysis_table(const AnalysisOptions& options, const nlohmann::json& result);

/// {name, feasible, reason, energy_J, motion_energy_J, duration_s, optimum_J, optimum_motion_J, later_s}; the
/// optimum is the least energy in the same time, later_s is there only if it is late. The figures of a
/// profile that cannot be driven are null.
[[nodiscard]] nlohmann::json baseline_json(const BaselineTotal& total);

}  // namespace joulepath
