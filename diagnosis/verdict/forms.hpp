#pragma once

#include <string>

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// How far the data pull a law away from the catalog's form. Each effect's strength may vary with speed,
/// yaw rate, payload, acceleration and time of day by a share that laws are usually inexact by; the sum
/// of squares of what the data ask for, in those shares, is chi-squared with 5 degrees for a true law.
struct FormDoubt {
  double chi_squared{};
  std::string depends_on{};  ///< what the strength varies with most
};

[[nodiscard]] FormDoubt form_doubt(const Identification& identification, const std::string& label);

/// True where two or more of the names are laws of friction against speed: together they can draw any
/// such curve, and stand for one that the catalog does not have.
[[nodiscard]] bool draws_a_friction_curve(const std::vector<ActiveEffect>& named);

/// Takes names back whose law is not the catalog's.
void judge_forms(Examination& examination);

}  // namespace joulepath
