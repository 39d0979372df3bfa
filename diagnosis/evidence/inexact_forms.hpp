#pragma once

#include <vector>

#include "diagnosis/evidence/equations.hpp"
#include "diagnosis/evidence/linear_fit.hpp"

namespace joulepath {

/// Forms of a fitted set whose law varies with a variable by more than laws do, or surely by more than a
/// fifth: such a law is not the whole cause. A form counts where its variable differs within the runs: a
/// payload that all of them carry is the law's size.
/// \param columns of the set \returns columns of the inexact forms
[[nodiscard]] std::vector<int> inexact_forms(const LinearProblem& problem, const Equations& equations,
                                             const std::vector<int>& columns, double dispersion);

}  // namespace joulepath
