#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "planner/values/plan.hpp"

namespace joulepath {

/// The summary of `plan` on the terminal: legs, energy by cause, baselines, battery, output files.
void print_plan_summary(std::ostream& stream, const Plan& plan, const std::string& directory);

/// "0.24 s later" than the plan.
[[nodiscard]] std::string later_text(const BaselineTotal& baseline);

/// Header and row of a table of profiles: each one's time and energy, the least energy on the same path in
/// that time, and what that saves. A later profile is named so.
[[nodiscard]] std::vector<std::string> baseline_header();
[[nodiscard]] std::vector<std::string> baseline_cells(const BaselineTotal& baseline);

}  // namespace joulepath
