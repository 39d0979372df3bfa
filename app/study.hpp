#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/command.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// Common code of the commands that study one mission or path, print a table and optionally write one JSON
/// file and report.html.
struct StudyOptions {
  MissionSource source{};
  std::string out{};  ///< empty: nothing is written
  PlanOptions plan{.solver = SolverChoice::fast,
                   .baselines = false};  // these commands do not use the plan's own baselines
  CommonOptions common{};
};

/// Adds the input, --out and the common flags.
void add_study_options(CommandLine& line, StudyOptions& options, const std::string& result_file,
                       bool with_time = true);

/// The output directory. Throws ConfigError if results exist and --force is not given.
[[nodiscard]] OutputDirectory study_output(const StudyOptions& options, const std::string& result_file);
[[nodiscard]] bool study_writes(const StudyOptions& options);

/// Writes the result and its report.
void write_study(OutputDirectory& out, const std::string& result_file, const nlohmann::json& result,
                 std::string report_html);

/// Prints the result under --json. Returns true if the caller must print the table.
[[nodiscard]] bool study_prints(const StudyOptions& options, const nlohmann::json& result);

/// {name, feasible, reason, energy_J, motion_energy_J, duration_s, later_s}; the last only if it is late.
[[nodiscard]] nlohmann::json baseline_json(const BaselineTotal& total);

}  // namespace joulepath
