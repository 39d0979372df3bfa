#include "diagnosis/evidence/inexact_forms.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/normal_quantiles.hpp"
// Design: docs/decisions/0505-unknown-terms.md
namespace joulepath {
namespace {

bool is_form(const Equations& equations, int column) {
  return equations.columns[static_cast<std::size_t>(column)].kind == Column::Kind::form;
}

/// How far a form is from the textbook's, in sigmas of what its prior lets the data find.
double form_sigmas(const Posterior& posterior, Eigen::Index at) {
  const double found = kFormSpread * kFormSpread - posterior.covariance(at, at);
  return found > 0 ? std::abs(posterior.mean[at]) / std::sqrt(found) : 0.0;
}

bool is_inexact(const Posterior& posterior, Eigen::Index at) {
  return form_sigmas(posterior, at) >= kInexactForm ||
         std::abs(posterior.mean[at]) - kNormal95 * std::sqrt(posterior.covariance(at, at)) >= kSureForm;
}

bool is_told(const LinearProblem& problem, const Equations& equations, int form) {
  const Column& column = equations.columns[static_cast<std::size_t>(form)];
  const auto part = static_cast<std::size_t>(column.part) / kFormVariables.size();
  const int law = equations.columns_of_candidate(column.owner, false)[part];
  const auto& gram = problem.gram;
  return std::abs(gram(law, form)) < kSameSignature * std::sqrt(gram(law, law) * gram(form, form));
}

}  // namespace

std::vector<int> inexact_forms(const LinearProblem& problem, const Equations& equations,
                               const std::vector<int>& columns, double dispersion) {
  std::vector<int> inexact;
  if (std::ranges::none_of(columns, [&](int k) { return is_form(equations, k); })) return inexact;
  const Posterior posterior = solve(problem, columns, dispersion);
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (is_form(equations, columns[k]) && is_told(problem, equations, columns[k]) &&
        is_inexact(posterior, static_cast<Eigen::Index>(k)))
      inexact.push_back(columns[k]);
  return inexact;
}

}  // namespace joulepath
