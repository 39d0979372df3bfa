#include "diagnosis/verdict/names.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Share of a named effect that the inexact form of the others could produce.
double ghost_share_of(const Examination& x, const std::string& label) {
  const Identification& id = x.id;
  for (int c : id.explanations.front().candidates)
    if (id.equations.candidates[static_cast<std::size_t>(c)].label() == label)
      return ghost_share(id.problem, id.equations, id.explanations.front(), c);
  return 1.0;
}

/// A further effect of the mechanics with little energy and little of the evidence.
bool may_be_form_error(const Examination& x, std::size_t e) {
  const ModelState& state = x.id.state;
  if (state.effects.size() < 2 || is_instrument(state.effects[e].candidate.shape.name)) return false;
  ModelState without = state;
  without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(e));
  Impact impact = impact_between(x.id.signals, x.point_of(state), x.point_of(without));
  impact.motor_power = impact.battery_power = 0;  // what is left shows outside the mechanics
  if (materiality(impact) >= 1) return false;
  const EnergyShare energy = energy_of_effect(x.id.signals, x.dataset.robot, x.id.nuisances, state, e);
  if (energy.effect_J > kFormErrorEnergy * energy.total_J) return false;
  const std::string label = state.effects[e].candidate.label();
  return ghost_share_of(x, label) > kGhost && gain_share_of(x, label) < kMinorGain;
}

/// Effects that the data cannot separate share the probability that one of them is there by their likelihood,
/// not by their typical size.
void share_probabilities(const Identification& id, Names& names) {
  for (int c : id.explanations.front().candidates) {
    const std::string label = id.equations.candidates[static_cast<std::size_t>(c)].label();
    const std::vector<StandIn> others =
        stand_ins(id.problem, id.equations, id.explanations, c, id.dispersion);
    double weight = 1;
    std::set<std::string> group{label};
    for (const StandIn& other : others) {
      names.stand_ins[label].push_back(other.label);
      group.insert(other.label);
      weight += std::exp(-0.5 * kScoreFlattening * other.loss_more);
    }
    if (others.empty()) continue;
    const double share = probability_of_any(id.equations, id.explanations, group) / weight;
    names.probabilities[label] = share;
    for (const StandIn& other : others)
      names.probabilities[other.label] = share * std::exp(-0.5 * kScoreFlattening * other.loss_more);
  }
}

}  // namespace

double gain_share_of(const Examination& x, const std::string& label) {
  const Identification& id = x.id;
  const Explanation& best = x.best();
  std::vector<int> columns;
  for (int c : best.candidates)
    if (id.equations.candidates[static_cast<std::size_t>(c)].label() != label)
      for (int k : id.equations.columns_of_candidate(c, true)) columns.push_back(k);
  const double nothing = solve(id.problem, {}, id.dispersion).loss,
               others = solve(id.problem, columns, id.dispersion).loss;
  return nothing > best.loss ? (others - best.loss) / (nothing - best.loss) : 0.0;
}

double probability_of(const Names& names, const ActiveEffect& effect) {
  const auto found = names.probabilities.find(effect.candidate.label());
  return found == names.probabilities.end() ? 0.0 : std::min(names.surest, found->second);
}

Names choose_names(const Examination& x) {
  const std::vector<ActiveEffect>& best = x.id.state.effects;
  Names names{.probabilities = effect_probabilities(x.id.equations, x.id.explanations)};
  share_probabilities(x.id, names);
  names.surest = x.runs.diagnosis.runs.size() < kRunsForSmallEffects ? kSurestOfFewRuns : kSurest;
  std::vector<std::string> doubted;
  for (std::size_t e = 0; e < best.size(); ++e) {
    const std::string label = best[e].candidate.label();
    if (names.probabilities[label] < kLeastProbabilityNamed && !names.stand_ins.contains(label) &&
        best.size() > 1)
      continue;  // the other sets do without it
    if (may_be_form_error(x, e))
      doubted.push_back(label);
    else
      names.named.push_back(best[e]);
  }
  if (names.named.empty()) {  // none is the greater one
    names.named = best;
    return names;
  }
  for (const std::string& label : doubted) {
    names.probabilities[label] = std::min(names.probabilities[label], kFormErrorProbability);
    names.notes.push_back(
        label + " is not named: it is small compared with a greater effect, whose inexact form may cause it");
  }
  return names;
}

std::vector<RankedEffect> rank_effects(const std::map<std::string, double>& probabilities, double surest) {
  std::vector<RankedEffect> ranking;
  for (const auto& [label, probability] : probabilities)
    if (probability > kLeastProbabilityRanked) ranking.push_back({label, probability});
  std::stable_sort(ranking.begin(), ranking.end(), [](const RankedEffect& a, const RankedEffect& b) {
    return a.probability > b.probability;
  });
  if (ranking.size() > kLongestRanking) ranking.resize(kLongestRanking);
  for (RankedEffect& entry : ranking) entry.probability = std::min(surest, entry.probability);
  return ranking;
}

}  // namespace joulepath
