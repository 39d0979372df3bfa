#pragma once

#include <iosfwd>
#include <string>

#include "planner/values/plan.hpp"

namespace joulepath {

/// What `plan` says on the terminal: legs, energy by cause, against the baselines, battery, where the files
/// are.
void print_plan_summary(std::ostream& stream, const Plan& plan, const std::string& directory);

/// A baseline's name for a table; with the seconds by which it is later than the plan.
[[nodiscard]] std::string baseline_name(const BaselineTotal& baseline);

}  // namespace joulepath
