#pragma once

#include <string>

#include "planner/values/infeasibility.hpp"

namespace joulepath {

/// Constraint, place, amount and relaxation of a verdict as a sentence.
[[nodiscard]] std::string sentence(const Infeasibility& verdict);

}  // namespace joulepath
