#include "diagnosis/energies_only/energy_folds.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

double sum_of_sizes(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += std::abs(value);
  return sum;
}

using GapsOf = std::function<Eigen::VectorXd(const EnergyFold&)>;

HeldOutGaps gather(const EnergyProblem& problem, const std::vector<EnergyFold>& folds,
                   const GapsOf& after_J) {
  const EnergyFit nothing{.state = {.nuisance_fraction = std::vector<double>(problem.nuisances.size(), 0.0)},
                          .doubts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kMotionDoubts.size()))};
  HeldOutGaps gaps;
  for (const EnergyFold& fold : folds) {
    const Eigen::VectorXd before = energy_gaps_J(problem, nothing, fold.judged), after = after_J(fold);
    gaps.runs.insert(gaps.runs.end(), fold.judged.begin(), fold.judged.end());
    gaps.before_J.insert(gaps.before_J.end(), before.begin(), before.end());
    gaps.after_J.insert(gaps.after_J.end(), after.begin(), after.end());
    for (std::size_t r : fold.judged) gaps.measured_J.push_back(problem.runs[r].measured_J());
  }
  return gaps;
}

}  // namespace

double HeldOutGaps::sum_before_J() const { return sum_of_sizes(before_J); }
double HeldOutGaps::sum_after_J() const { return sum_of_sizes(after_J); }

std::vector<EnergyFold> energy_folds(const Dataset& dataset, const std::vector<EnergyRun>& runs) {
  EnergyFold told;
  for (std::size_t r = 0; r < runs.size(); ++r)
    (dataset.runs[runs[r].run_index].use == RunUse::validation ? told.judged : told.fitted).push_back(r);
  if (!told.judged.empty()) return {told};
  std::vector<std::size_t> order = every(runs.size());
  const auto key = [&](std::size_t r) {
    return std::tuple(runs[r].path, runs[r].payload_kg, runs[r].acceleration_m_s2, runs[r].measured_J());
  };
  std::ranges::stable_sort(order, {}, key);
  std::vector<EnergyFold> folds(std::min(kEnergyFolds, runs.size()));
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t f = 0; f < folds.size(); ++f)
      (k % folds.size() == f ? folds[f].judged : folds[f].fitted).push_back(order[k]);
  return folds;
}

HeldOutGaps held_out_gaps(const EnergyProblem& problem, const std::vector<EnergyFold>& folds) {
  return gather(problem, folds, [&](const EnergyFold& fold) {
    const std::vector<Candidate> chosen =
        candidates_of(problem, explain_energies(problem, fold.fitted).front());
    return energy_gaps_J(problem, fit_energies(problem, fold.fitted, chosen), fold.judged);
  });
}

HeldOutGaps held_out_gaps(const EnergyProblem& problem, const std::vector<EnergyFold>& folds,
                          const std::vector<Candidate>& effects) {
  return gather(problem, folds, [&](const EnergyFold& fold) {
    return energy_gaps_J(problem, fit_energies(problem, fold.fitted, effects), fold.judged);
  });
}

HeldOutGaps smooth_held_out_gaps(const EnergyProblem& problem, const std::vector<EnergyFold>& folds) {
  const EnergyFit nothing{.state = {.nuisance_fraction = std::vector<double>(problem.nuisances.size(), 0.0)},
                          .doubts = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kMotionDoubts.size()))};
  return gather(problem, folds, [&](const EnergyFold& fold) {
    Eigen::VectorXd left_J = energy_gaps_J(problem, nothing, fold.judged);
    const Eigen::VectorXd expected = smooth_error(problem.runs, fold.fitted, fold.judged, problem.robot);
    for (std::size_t i = 0; i < fold.judged.size(); ++i)
      left_J[static_cast<Eigen::Index>(i)] -=
          expected[static_cast<Eigen::Index>(i)] * std::abs(problem.runs[fold.judged[i]].measured_J());
    return left_J;
  });
}

}  // namespace joulepath
