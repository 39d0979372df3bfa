#include "diagnosis/evidence/identify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/evidence/delay_search.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/evidence/region_search.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0040-diagnosis-by-joint-evidence.md
namespace joulepath {
namespace {

std::vector<std::string> labels_of(const Equations& equations, const Explanation& explanation) {
  std::vector<std::string> labels;
  for (int c : explanation.candidates)
    labels.push_back(equations.candidates[static_cast<std::size_t>(c)].label());
  std::sort(labels.begin(), labels.end());
  return labels;
}

/// The columns of the state's own effects.
std::vector<int> columns_of(const Equations& equations, const ModelState& state) {
  std::vector<int> columns;
  for (std::size_t c = 0; c < state.effects.size(); ++c)
    for (int k : equations.columns_of_candidate(static_cast<int>(c), true)) columns.push_back(k);
  return columns;
}

std::vector<std::string> labels_of(const ModelState& state) {
  std::vector<std::string> labels;
  for (const ActiveEffect& effect : state.effects) labels.push_back(effect.candidate.label());
  std::sort(labels.begin(), labels.end());
  return labels;
}

SearchOptions search_options(double dispersion, bool few, std::vector<double> least_amplitude) {
  return {.dispersion = dispersion,
          .least_amplitude = std::move(least_amplitude),
          .small_effect_evidence = few ? kSmallEffectEvidenceOfFewRuns : kSmallEffectEvidence,
          .small_pliable_evidence = few ? std::numeric_limits<double>::infinity() : kSmallPliableEvidence};
}

/// Effects of the best set of all that are not large enough to matter, nor beyond doubt.
std::vector<SmallEffect> small_effects(const Equations& equations,
                                       const std::vector<Explanation>& explanations) {
  const Explanation& best = explanations.front();
  std::vector<SmallEffect> small;
  if (best.material) return small;
  Inclusion inclusion;
  inclusion.add(equations, explanations);
  for (std::size_t k = 0; k < best.candidates.size(); ++k) {
    if (best.size[k] >= 1) continue;
    const std::string label = equations.candidates[static_cast<std::size_t>(best.candidates[k])].label();
    const double probability = inclusion.of(label);
    if (probability < kLeastProbabilityNamed) continue;
    double without = -1e300;
    for (const Explanation& e : explanations)
      if (std::ranges::count(labels_of(equations, e), label) == 0) without = std::max(without, e.score);
    small.push_back({label, probability, best.score - without, best.size[k]});
  }
  return small;
}

}  // namespace

Identification identify(const LogSet& logs, const std::set<std::string>& without) {
  Identification result{.nuisances = calibration_nuisances(logs.dataset->robot)};
  const Robot& robot = logs.dataset->robot;
  const std::vector<std::size_t> runs = every(logs.runs.size());
  result.state.nuisance_fraction.assign(result.nuisances.size(), 0.0);
  if (const double delay_s = rough_channel_delay_s(logs); delay_s != 0) {
    const std::vector<Candidate> candidates = catalog_candidates(robot, without);
    const auto delay = std::ranges::find_if(
        candidates, [](const Candidate& candidate) { return candidate.effect().delays_channels; });
    if (delay != candidates.end()) result.state.effects.push_back({*delay, {delay_s}});
  }
  result.signals = read_signals(logs, channel_delay_s(result.state));
  const bool few = runs.size() < kRunsForSmallEffects;
  std::map<std::string, double> known;
  NoiseModel noise;
  for (int round = 0;; ++round) {
    const std::vector<Candidate> regions =
        region_candidates(result.signals, robot, result.nuisances, result.state, without);
    result.equations = build_equations(result.signals, robot, result.nuisances, result.state, regions,
                                       {.first_noise = round > 0 ? &noise : nullptr, .without = without});
    noise = result.equations.noise;
    result.dispersion = run_dispersion(result.equations, rich_columns(result.equations));
    result.problem = without_calibration(result.equations, runs, result.dispersion);
    scale_unknowns(result.equations, result.problem, columns_of(result.equations, result.state),
                   result.dispersion);
    result.options = search_options(result.dispersion, few,
                                    least_amplitudes(result.signals, robot, result.nuisances, result.state,
                                                     result.equations.candidates, known));
    result.explanations = search_explanations(result.problem, result.equations, result.options);
    result.below_materiality = small_effects(result.equations, result.explanations);
    std::erase_if(result.explanations, [](const Explanation& e) { return !e.material; });
    const Explanation& best = result.explanations.front();
    if ((round > 0 || best.candidates.empty()) &&
        labels_of(result.equations, best) == labels_of(result.state))
      break;
    const Eigen::VectorXd parameters =
        fit_parameters(result.equations, runs, best.columns, result.dispersion);
    Refit fitted = refit(logs, runs, result.nuisances,
                         adopt(result.equations, result.nuisances, result.state, best, parameters),
                         result.equations.noise, result.equations.run_variance, result.dispersion, 2,
                         unknown_labels(result.equations, best));
    result.state = fitted.state;
    result.signals = std::move(fitted.signals);
    if (round == kRelinearizations) break;  // no convergence: the last answer, refitted
  }
  return result;
}

std::set<std::string> unknown_labels(const Equations& equations, const Explanation& explanation) {
  std::set<std::string> labels;
  for (int u : explanation.unknowns) labels.insert(equations.unknowns[static_cast<std::size_t>(u)].label);
  return labels;
}

double energy_of_effect_J(const std::vector<RunSignals>& signals, const Robot& robot,
                          const std::vector<Nuisance>& nuisances, const ModelState& state,
                          std::size_t effect) {
  ModelState without = state;
  without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  std::vector<double> run_J(signals.size());
  parallel_for(signals.size(), [&](std::size_t r) {
    const Prediction with_it = predict(signals[r], model_point(robot, nuisances, state));
    const Prediction without_it = predict(signals[r], model_point(robot, nuisances, without));
    for (Side side : kSides)
      run_J[r] += signals[r].period_s * (with_it.power_W[side] - without_it.power_W[side]).sum();
  });
  double sum_J = 0;
  for (double effect_J : run_J) sum_J += std::abs(effect_J);
  return sum_J;
}

}  // namespace joulepath
