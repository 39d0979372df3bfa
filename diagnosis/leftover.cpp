#include "diagnosis/leftover.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/indices.hpp"

namespace joulepath {
namespace {

/// Loss that one free column buys by chance, and how much more counts as a finding: calibrated on
/// development cases.
constexpr double kChancePerColumn = 3.0;
constexpr double kLeastEvidence = 40.0;
constexpr double kManyRuns = 18.0;  ///< with fewer, the noise is known less: more evidence is asked for
constexpr double kLeastShare = 0.06;
constexpr double kCalibrationBox = 3.0;  ///< of a nuisance's sigma: beyond it is no calibration error

/// Loss without any effect, calibration errors kept inside their box: one that may go on for ever makes
/// any gap that looks like it seem small.
double loss_within_calibration(const Identification& id) {
  const Equations& equations = id.equations;
  LinearProblem problem = sum_runs(equations.runs, every(equations.runs.size()), equations.prior_sd);
  std::vector<int> open = equations.columns_of(Column::Kind::nuisance);
  while (true) {
    const Posterior fit = solve(problem, open, id.dispersion);
    Eigen::Index worst = -1;
    double most = kCalibrationBox;
    for (Eigen::Index k = 0; k < fit.mean.size(); ++k) {
      const double sigmas = std::abs(fit.mean[k]) / problem.prior_sd[open[static_cast<std::size_t>(k)]];
      if (sigmas > most) most = sigmas, worst = k;
    }
    if (worst < 0) return fit.loss;
    const int column = open[static_cast<std::size_t>(worst)];
    const double held = std::copysign(kCalibrationBox * problem.prior_sd[column], fit.mean[worst]);
    problem.residual_square += held * held * problem.gram(column, column) - 2 * held * problem.right[column];
    problem.right -= held * problem.gram.col(column);
    open.erase(open.begin() + worst);
  }
}

}  // namespace

Leftover find_leftover(const Identification& id, const std::vector<int>& columns) {
  const Equations& equations = id.equations;
  const LinearProblem problem = without_calibration(equations, every(equations.runs.size()), id.dispersion);
  const double nothing = loss_within_calibration(id);
  const double explained = solve(problem, columns, id.dispersion).loss;
  std::map<std::string, std::vector<int>> families;
  std::vector<int> all = columns;
  for (int k : equations.columns_of(Column::Kind::dictionary)) {
    const DictionaryEntry& entry =
        equations.dictionary[static_cast<std::size_t>(equations.columns[static_cast<std::size_t>(k)].owner)];
    families[entry.family + " (" + entry.channel + ")"].push_back(k);
    all.push_back(k);
  }
  const auto chance = [](std::size_t count) { return kChancePerColumn * static_cast<double>(count); };
  Leftover leftover;
  leftover.evidence =
      explained - solve(problem, all, id.dispersion).loss - chance(all.size() - columns.size());
  const double possible = std::max(1.0, (nothing - explained) + std::max(0.0, leftover.evidence));
  leftover.share = std::clamp(leftover.evidence / possible, 0.0, 1.0);
  const double runs = std::min(kManyRuns, static_cast<double>(equations.runs.size()));
  const double least = kLeastEvidence * std::pow(kManyRuns / runs, 1.9);
  leftover.significant = leftover.evidence > least && leftover.share > kLeastShare;
  if (!leftover.significant) return leftover;
  std::vector<std::pair<double, std::string>> gains;
  for (const auto& [name, family] : families) {
    std::vector<int> with_family = columns;
    with_family.insert(with_family.end(), family.begin(), family.end());
    gains.push_back(
        {explained - solve(problem, with_family, id.dispersion).loss - chance(family.size()), name});
  }
  std::stable_sort(gains.begin(), gains.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t k = 0; k < gains.size() && k < 3; ++k)
    if (gains[k].first > 0.2 * gains[0].first && gains[k].first > 0)
      leftover.description += (leftover.description.empty() ? "depends on " : ", then ") + gains[k].second;
  return leftover;
}

}  // namespace joulepath
