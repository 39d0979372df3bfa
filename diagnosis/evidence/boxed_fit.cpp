#include "diagnosis/evidence/boxed_fit.hpp"

#include <cmath>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0503-evidence.md
namespace joulepath {

BoxedFit fit_within_calibration(const Identification& id) {
  const Equations& equations = id.equations;
  LinearProblem problem = sum_runs(equations.runs, every(equations.runs.size()), equations.prior_sd);
  std::vector<int> open = equations.columns_of(Column::Kind::nuisance);
  BoxedFit boxed;
  while (true) {
    const Posterior fit = solve(problem, open, id.dispersion);
    Eigen::Index worst = -1;
    double most = kCalibrationBox;
    for (Eigen::Index k = 0; k < fit.mean.size(); ++k) {
      const double sigmas = std::abs(fit.mean[k]) / problem.prior_sd[open[static_cast<std::size_t>(k)]];
      if (sigmas > most) most = sigmas, worst = k;
    }
    boxed.loss = fit.loss;
    if (worst < 0) return boxed;
    const int column = open[static_cast<std::size_t>(worst)];
    const double held = std::copysign(kCalibrationBox * problem.prior_sd[column], fit.mean[worst]);
    problem.residual_square += held * held * problem.gram(column, column) - 2 * held * problem.right[column];
    problem.right -= held * problem.gram.col(column);
    boxed.held.push_back(column);
    open.erase(open.begin() + worst);
  }
}

double score_of_constant(const Identification& id, int column) {
  const Equations& equations = id.equations;
  const std::vector<int> nuisances = equations.columns_of(Column::Kind::nuisance);
  LinearProblem problem = sum_runs(equations.runs, every(equations.runs.size()), equations.prior_sd);
  const double held = solve(problem, nuisances, id.dispersion, false).log_evidence;
  problem.prior_sd[column] *= kFreeAmplitude;
  return solve(problem, nuisances, id.dispersion, false).log_evidence - held - kEffectCost;
}

int effect_of_constant(const Identification& id, int column) {
  const Equations& equations = id.equations;
  const LinearProblem problem = sum_runs(equations.runs, every(equations.runs.size()), equations.prior_sd);
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    const std::vector<int> own = equations.columns_of_candidate(static_cast<int>(c), false);
    if (own.size() != 1) continue;
    const double scale = std::sqrt(problem.gram(column, column) * problem.gram(own[0], own[0]));
    if (scale > 0 && std::abs(problem.gram(column, own[0])) > kSameSignature * scale)
      return static_cast<int>(c);
  }
  return -1;
}

std::string calibration_name(const Identification& id, int column) {
  const int owner = id.equations.columns[static_cast<std::size_t>(column)].owner;
  return text_of(id.nuisances[static_cast<std::size_t>(owner)]);
}

}  // namespace joulepath
