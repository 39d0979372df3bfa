#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "planner/values/plan.hpp"

namespace joulepath {

/// The summary of `plan` on the terminal: legs, energy by cause, baselines, battery, output files.
void print_plan_summary(std::ostream& out, const Plan& plan, const std::string& directory);

/// Header and row of a table of profiles: each one's time and energy, the least energy on the same path in
/// that time, and what that saves. A later profile is named so.
[[nodiscard]] std::vector<std::string> baseline_header();
[[nodiscard]] std::vector<std::string> baseline_cells(const BaselineTotal& baseline);

/// Why a profile is infeasible, in a line under its table; nothing where it is feasible.
void print_baseline_reason(std::ostream& out, const BaselineTotal& baseline);

}  // namespace joulepath
