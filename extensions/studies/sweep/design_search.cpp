#include "extensions/studies/sweep/design_search.hpp"

#include <cmath>
#include <limits>

#include "extensions/studies/sweep/nlopt_run.hpp"

// Method: [Rowan1990]
namespace joulepath {
namespace {

bool is_better(const DesignValue& a, const DesignValue& b) {
  if (a.planned != b.planned) return a.planned;
  if (a.excess != b.excess && (a.excess > 0 || b.excess > 0)) return a.excess < b.excess;
  return a.objective < b.objective;
}

}  // namespace

DesignSearch search_design(std::vector<double> start, std::size_t most_evaluations, double tolerance,
                           const std::function<DesignValue(const std::vector<double>&)>& evaluate) {
  DesignSearch search{.best = start};
  double scale = 0.0;  // of the objective: its value at the first design with a plan
  const auto cost = [&](const std::vector<double>& fractions) {
    const DesignValue value = evaluate(fractions);
    ++search.evaluations;
    if (search.evaluations == 1 || is_better(value, search.value)) {
      search.value = value;
      search.best = fractions;
    }
    if (!value.planned) return std::numeric_limits<double>::max();
    if (scale == 0.0) scale = std::max(std::abs(value.objective), 1e-9);
    return value.objective + 100.0 * scale * value.excess;
  };
  using Cost = decltype(cost);
  nlopt::opt solver(nlopt::LN_SBPLX, static_cast<unsigned>(start.size()));
  solver.set_lower_bounds(0.0);
  solver.set_upper_bounds(1.0);
  solver.set_initial_step(0.1);
  solver.set_xtol_abs(tolerance);
  solver.set_maxeval(static_cast<int>(most_evaluations));
  solver.set_min_objective([](const std::vector<double>& x, std::vector<double>&,
                              void* data) { return (*static_cast<Cost*>(data))(x); },
                           const_cast<std::remove_const_t<Cost>*>(&cost));
  optimize_as_far_as_possible(solver, start);
  return search;
}

}  // namespace joulepath
