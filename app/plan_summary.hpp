#pragma once

#include <iosfwd>
#include <string>

#include "planner/values/plan.hpp"

namespace joulepath {

/// The summary of `plan` on the terminal: legs, energy by cause, baselines, battery, output files.
void print_plan_summary(std::ostream& stream, const Plan& plan, const std::string& directory);

/// A baseline's name for a table, with its delay in seconds if it is later than the plan.
[[nodiscard]] std::string baseline_name(const BaselineTotal& baseline);

}  // namespace joulepath
