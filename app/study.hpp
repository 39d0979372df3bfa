#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/command.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// What the commands share that study one mission or path, print a table and, where asked, write one JSON
/// file and report.html.
struct StudyOptions {
  MissionSource source{};
  std::string out{};                                                   ///< empty: nothing is written
  PlanOptions plan{.solver = SolverChoice::fast, .baselines = false};  // none of them reads the plan's own
  CommonOptions common{};
};

/// Adds what is studied, --out and the common flags.
void add_study_options(CommandLine& line, StudyOptions& options, const std::string& result_file,
                       bool with_time = true);

/// Where the results go. Throws ConfigError when they exist and --force is not given.
[[nodiscard]] OutputDirectory study_output(const StudyOptions& options, const std::string& result_file);
[[nodiscard]] bool study_writes(const StudyOptions& options);

/// Writes the result and its report.
void write_study(OutputDirectory& out, const std::string& result_file, const nlohmann::json& result,
                 std::string report_html);

/// Prints the result under --json. True where it is the table that is to be printed.
[[nodiscard]] bool study_prints(const StudyOptions& options, const nlohmann::json& result);

/// {name, feasible, reason, energy_J, motion_energy_J, duration_s, later_s}; the last where it is late.
[[nodiscard]] nlohmann::json baseline_json(const BaselineTotal& total);

}  // namespace joulepath
