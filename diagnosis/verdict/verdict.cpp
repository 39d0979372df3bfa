#include "diagnosis/verdict/verdict.hpp"

#include <algorithm>
#include <limits>

#include "diagnosis/evidence/boxed_fit.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0506-verdict.md
namespace joulepath {
namespace {

constexpr double kBeyondCalibration = std::numeric_limits<double>::infinity();  ///< a finding of any size

/// "depends on wheel speed (current), then payload (current)".
std::string in_words(const std::vector<UnknownCause>& unknowns) {
  if (unknowns.empty()) return "";
  return "depends on " + text_of_list(unknowns, &UnknownCause::depends_on, ", then ");
}

/// Something matters, and no name is sure: the likeliest effect, in words.
std::string likeliest(const Names& names) {
  const std::vector<RankedEffect> ranking = rank_effects(names.probabilities, names.surest);
  return ranking.empty() ? "no variable alone" : ranking.front().effect + ", which is not sure";
}

/// The evidence of the surest effect that is too small to count; none: 0.
double evidence_of_small(const Examination& x) {
  double most = 0;
  for (const SmallEffect& small : x.id.below_materiality) most = std::max(most, small.evidence);
  return most;
}

/// Whether a constant is of the log's stamps, which name a sample's beginning, middle or end, and deviates by
/// less than a delay that counts.
bool is_convention_of_stamps(const Examination& x, int column) {
  const int c = effect_of_constant(x.id, column);
  if (c < 0 || !x.id.equations.candidates[static_cast<std::size_t>(c)].effect().delays_channels) return false;
  const std::string label = x.id.equations.candidates[static_cast<std::size_t>(c)].label();
  return std::ranges::any_of(x.id.below_materiality,
                             [&](const SmallEffect& small) { return small.effect == label; });
}

/// The calibration constant (its column) that is furthest beyond its uncertainty, where nothing else won, or
/// where no law of the catalog changes it and it explains more than the best set does; none: -1. A constant
/// that explains less than an effect too small to count only stands in for it.
int constant_that_wins(const Examination& x, bool nothing_won) {
  const BoxedFit nothing = fit_within_calibration(x.id);
  const double loss = solve(x.id.problem, {}, x.id.dispersion).loss;
  const auto held =
      std::ranges::find_if_not(nothing.held, [&](int column) { return is_convention_of_stamps(x, column); });
  if (held == nothing.held.end() || nothing.loss - loss < kLeastLossOfBox) return -1;
  const int column = *held;
  const double score = score_of_constant(x.id, column);
  if (score < evidence_of_small(x)) return -1;
  if (nothing_won) return column;
  return effect_of_constant(x.id, column) < 0 && score > x.best().score ? column : -1;
}

/// What a calibration constant's deviation (its column) changes, over the materiality floor.
double size_of_constant(const Examination& x, int column) {
  const Equations& equations = x.id.equations;
  const Eigen::VectorXd parameters =
      fit_parameters(equations, every(equations.runs.size()), {}, x.id.dispersion);
  const auto owner = static_cast<std::size_t>(equations.columns[static_cast<std::size_t>(column)].owner);
  ModelState without{.nuisance_fraction = std::vector<double>(x.id.nuisances.size(), 0.0)}, with_it = without;
  with_it.nuisance_fraction[owner] = parameters[column];
  return materiality(impact_between(x.id.signals, x.point_of(with_it), x.point_of(without)));
}

/// A constant beyond its uncertainty is reported as the effect that changes the same number: whatever its
/// size where the race is sure of it, else as one candidate of several, with the size of the constant's
/// deviation. The verdict is unexplained if the catalog has no such effect, or if the race gives it hardly
/// any probability.
Judgment judge_constant(const Examination& x, const Names& names, int column) {
  if (const int candidate = effect_of_constant(x.id, column); candidate >= 0) {
    const ActiveEffect effect{x.id.equations.candidates[static_cast<std::size_t>(candidate)], {0.0}};
    const std::string label = effect.candidate.label();
    const double probability = probability_of(names, effect);
    if (probability >= kLeastProbabilityNamed)
      return {.verdict = Verdict::explained, .named = {effect}, .sizes = {.greatest = kBeyondCalibration}};
    if (probability >= kLeastProbabilityOfConstant) {
      const double size = size_of_constant(x, column);
      const double evidence = evidence_for(x.id.equations, x.id.explanations, label);
      return {.verdict = Verdict::ambiguous,
              .named = {effect},
              .sizes = {.greatest = size, .of_names = {{label, probability, evidence, size}}}};
    }
  }
  return {.verdict = Verdict::unexplained,
          .depends_on = "goes with " + calibration_name(x.id, column) +
                        ", further from its value than calibration errors",
          .sizes = {.greatest = size_of_constant(x, column)}};
}

}  // namespace

bool has_small_effect(const Examination& x) {
  return std::ranges::any_of(x.id.below_materiality, [](const SmallEffect& small) {
    return small.probability >= kLeastProbabilityNamed;
  });
}

Judgment judge(const Examination& x, const Names& names) {
  if (x.runs.few)
    return {.notes = {"fewer than " + std::to_string(kLeastRunsToName) +
                      " runs: candidates only; add runs with two payloads, both directions and turns"}};
  Judgment judgment{.named = names.named,
                    .unknowns = names.unknowns,
                    .depends_on = in_words(names.unknowns),
                    .sizes = names.sizes};
  const bool nothing_won = names.named.empty() && names.unknowns.empty();
  if (const int column = constant_that_wins(x, nothing_won); column >= 0)
    return judge_constant(x, names, column);
  if (nothing_won) {
    judgment.verdict = Verdict::no_gap;
    if (names.small_unknowns.empty() && !has_small_effect(x) && names.something > kSurest) {
      judgment.verdict = Verdict::unexplained;
      judgment.depends_on = "goes with " + likeliest(names);
    }
    return judgment;
  }
  const bool sure = std::ranges::any_of(judgment.named, [&](const ActiveEffect& effect) {
    return probability_of(names, effect) >= kLeastProbabilityNamed;
  });
  judgment.verdict = names.named.empty()       ? Verdict::unexplained
                     : !names.unknowns.empty() ? Verdict::partly_explained
                     : sure                    ? Verdict::explained
                                               : Verdict::ambiguous;
  return judgment;
}

}  // namespace joulepath
