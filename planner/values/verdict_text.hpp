#pragma once

#include <cstddef>
#include <string>

#include "planner/values/infeasibility.hpp"

namespace joulepath {

/// Constraint, place, amount and relaxation of a verdict as a sentence.
[[nodiscard]] std::string sentence(const Infeasibility& verdict);

/// Whether a deadline or a duration is too early.
[[nodiscard]] bool is_late(const Infeasibility& verdict);

/// `2 (dock)`: texts count legs from 1 and name their goal, files and values count from 0.
[[nodiscard]] std::string leg_text(std::size_t leg, const std::string& to);

}  // namespace joulepath
