#include "diagnosis/correction/companions.hpp"

#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/numerics/indices.hpp"
// Design: docs/decisions/0504-small-effects-and-groups.md

namespace joulepath {
namespace {

/// The equations about the fit, with the forms that inexact laws may have, as in the search.
Equations equations_about(const Examination& x, const Refit& fitted, const std::set<std::string>& terms) {
  return build_equations(fitted.signals, x.dataset.robot, x.id.nuisances, fitted.state, {},
                         {.whole_catalog = false,
                          .dictionary = false,
                          .unknowns = terms,
                          .noise = &x.id.equations.noise,
                          .run_variance = &x.id.equations.run_variance});
}

}  // namespace

std::optional<std::size_t> weakest_companion(const Examination& x, const Refit& fitted,
                                             const std::set<std::string>& terms) {
  if (fitted.state.effects.size() < 2) return std::nullopt;
  Equations equations = equations_about(x, fitted, terms);
  LinearProblem problem = without_calibration(equations, every(equations.runs.size()), fitted.dispersion);
  std::vector<int> laws;
  for (int c = 0; c < std::ssize(equations.candidates); ++c)
    for (int k : equations.columns_of_candidate(c, true)) laws.push_back(k);
  scale_unknowns(equations, problem, laws, fitted.dispersion);
  std::map<std::string, double> known;
  const SearchOptions options =
      search_options(fitted.dispersion, fitted.fit_runs,
                     least_amplitudes(fitted.signals, x.dataset.robot, x.id.nuisances, fitted.state,
                                      equations.candidates, known));
  if (const std::optional<int> weakest = weakest_member(problem, equations, options))
    return static_cast<std::size_t>(*weakest);
  return std::nullopt;
}

}  // namespace joulepath
