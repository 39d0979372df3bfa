#include "diagnosis/evidence/leftover.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "diagnosis/evidence/left_out_gain.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0045-unseen-runs-and-boxes.md
namespace joulepath {
namespace {

/// Errors of time stamps or of a winding's inductance correlate voltage with acceleration: no finding.
const std::set<std::string> kOfTheLogger{"acceleration (voltage)"};

/// What calibration errors explain inside their box, and which of them are at its border.
struct BoxedFit {
  double loss{};
  std::vector<int> held{};  ///< columns, the one furthest out first
};

/// Loss without any effect, with calibration errors inside their box: an unbounded one makes any gap with
/// its signature seem small.
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

/// A calibration constant in words: "wheel_radius_m" or "friction_torque_Nm (left)".
std::string calibration_name(const Identification& id, int column) {
  const int owner = id.equations.columns[static_cast<std::size_t>(column)].owner;
  const Nuisance& nuisance = id.nuisances[static_cast<std::size_t>(owner)];
  if (!nuisance.side) return nuisance.key;
  return nuisance.key + " (" + side_name(*nuisance.side) + ")";
}

double by_chance(std::size_t count) { return kChancePerColumn * static_cast<double>(count); }

struct FamilyFinding {
  std::string name{};
  double gain{};
};

/// The family that saves most on runs that it has not seen; none where all may be chance.
FamilyFinding strongest_family(const Identification& id, const std::vector<int>& columns,
                               const DictionaryFamilies& families) {
  FamilyFinding strongest;
  for (const auto& [name, gain] : left_out_gains(id, columns, families))
    if (!kOfTheLogger.contains(name) && gain.gain > std::max(kLeastLeftover, strongest.gain) &&
        gain.over_scatter > kLeastFamilyErrors)
      strongest = {name, gain.gain};
  return strongest;
}

/// The families that explain most of the leftover, strongest first.
std::string depends_on(const LinearProblem& problem, const std::vector<int>& columns,
                       const DictionaryFamilies& families, double explained, double dispersion) {
  std::vector<std::pair<double, std::string>> gains;
  for (const auto& [name, family] : families) {
    std::vector<int> with_family = columns;
    with_family.insert(with_family.end(), family.begin(), family.end());
    gains.push_back(
        {explained - solve(problem, with_family, dispersion).loss - by_chance(family.size()), name});
  }
  std::stable_sort(gains.begin(), gains.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t k = 0; k < gains.size() && k < 3; ++k)
    if (gains[k].first > 0.2 * gains[0].first && gains[k].first > 0)
      text += (text.empty() ? "depends on " : ", then ") + gains[k].second;
  return text;
}

}  // namespace

Leftover find_leftover(const Identification& id, const std::vector<int>& columns) {
  const Equations& equations = id.equations;
  const LinearProblem& problem = id.problem;
  const BoxedFit nothing = fit_within_calibration(id);
  const double explained = solve(problem, columns, id.dispersion).loss;
  const DictionaryFamilies families = dictionary_families(equations);
  std::vector<int> all = columns;
  for (const auto& [name, family] : families)
    std::copy_if(family.begin(), family.end(), std::back_inserter(all),
                 [&](int k) { return problem.gram(k, k) > 0; });  // what no run shows costs nothing
  Leftover leftover;
  leftover.evidence =
      explained - solve(problem, all, id.dispersion).loss - by_chance(all.size() - columns.size());
  const auto share_of = [&](double evidence) {
    const double possible = std::max(1.0, (nothing.loss - explained) + std::max(0.0, evidence));
    return std::clamp(evidence / possible, 0.0, 1.0);
  };
  leftover.share = share_of(leftover.evidence);
  const double runs = std::min(kLeftoverManyRuns, static_cast<double>(equations.runs.size()));
  const double least = kLeastLeftover * std::pow(kLeftoverManyRuns / runs, kLeftoverRunsPower);
  leftover.significant = leftover.evidence > least && leftover.share > kLeastLeftoverShare;
  const FamilyFinding family = strongest_family(id, columns, families);
  if (share_of(family.gain) > kLeastLeftoverShare) {
    leftover.significant = true;
    leftover.evidence = std::max(leftover.evidence, family.gain);
    leftover.share = std::max(leftover.share, share_of(family.gain));
  }
  if (columns.empty() && !nothing.held.empty() && nothing.loss - explained > kLeastLossOfBox) {
    leftover.significant = true;
    leftover.evidence = std::max(leftover.evidence, nothing.loss - explained);
    leftover.share = 1.0;
    leftover.description = "goes with " + calibration_name(id, nothing.held.front()) +
                           ", further from its value than calibration errors";
  } else if (leftover.significant) {
    leftover.description = depends_on(problem, columns, families, explained, id.dispersion);
  }
  return leftover;
}

}  // namespace joulepath
