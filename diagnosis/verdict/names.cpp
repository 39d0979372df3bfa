#include "diagnosis/verdict/names.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/evidence/boxed_fit.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/normal_quantiles.hpp"
// Design: docs/decisions/0505-unknown-terms.md,
// docs/decisions/0507-cross-fitting.md
// Method: [BarbieriBerger2004]
namespace joulepath {
namespace {

/// Effects that the data cannot separate share the probability that one of them is there by their likelihood,
/// not by their typical size; those that runs favour by turns by their own. One that two effects could be
/// keeps its greater share.
void share_probabilities(const Examination& x, const Inclusion& inclusion, Names& names) {
  const Identification& id = x.id;
  std::set<std::string> shared;
  for (int c : id.explanations.front().candidates) {
    const std::string label = id.equations.candidates[static_cast<std::size_t>(c)].label();
    std::vector<StandIn> others =
        stand_ins(id.problem, id.equations, id.explanations, c, id.dispersion, x.dataset.robot);
    if (!others.empty()) names.inseparable[label] = others.front().label;
    std::ranges::copy(likely_rivals(id.equations, id.explanations, c, inclusion, others),
                      std::back_inserter(others));
    if (others.empty()) continue;
    double weight = 1;
    std::set<std::string> group{label};
    for (const StandIn& other : others) {
      names.stand_ins[label].push_back(other.label);
      group.insert(other.label);
      weight += likelihood_over_named(other);
    }
    const double share = inclusion.of_any(group) / weight;
    names.probabilities[label] = share;
    for (const StandIn& other : others) {
      double& probability = names.probabilities[other.label];
      const double own = share * likelihood_over_named(other);
      probability = shared.insert(other.label).second ? own : std::max(probability, own);
    }
  }
}

/// The best set's columns without some.
std::vector<int> columns_without(const Examination& x, const std::vector<int>& left_out) {
  std::vector<int> kept;
  std::ranges::copy_if(x.best().columns, std::back_inserter(kept),
                       [&](int k) { return std::ranges::count(left_out, k) == 0; });
  return kept;
}

/// Share of what the best set explains beyond calibration errors that is lost without some of its columns.
double share_lost(const Examination& x, const BoxedFit& nothing, const std::vector<int>& without) {
  const double all = nothing.loss - x.best().loss;
  if (all <= 0) return 0.0;
  const double kept = solve(x.id.problem, columns_without(x, without), x.id.dispersion).loss;
  return std::clamp((kept - x.best().loss) / all, 0.0, 1.0);
}

/// Unknown terms of one channel: that there is an unknown cause is often surer than what it depends on. A
/// current and its reading count as one: without the motor's voltage they look alike.
std::set<std::string> of_same_channel(const Equations& equations, const std::string& label) {
  const auto channel = [](const std::string& text) {
    const std::string name = text.substr(text.rfind('('));
    return name == "(current reading)" ? "(current)" : name;
  };
  std::set<std::string> labels;
  for (const UnknownTerm& term : equations.unknowns)
    if (channel(term.label) == channel(label)) labels.insert(term.label);
  return labels;
}

/// Size of an unknown term of the best set over the materiality floor.
double size_of(const Examination& x, const UnknownTerm& term) {
  std::vector<int> entries;
  Eigen::VectorXd strength(std::ssize(term.columns));
  for (int k : term.columns) {
    const auto at = std::ranges::find(x.best().columns, k) - x.best().columns.begin();
    strength[std::ssize(entries)] = x.best().mean[at];
    entries.push_back(x.id.equations.columns[static_cast<std::size_t>(k)].owner);
  }
  return materiality(impact_of_term(x.id.signals, x.point_of(x.id.state), entries, strength));
}

/// What the best set's log evidence loses without a term.
double evidence_of(const Examination& x, const UnknownTerm& term) {
  const auto evidence = [&](const std::vector<int>& columns) {
    return solve(x.id.problem, columns, x.id.dispersion, false).log_evidence;
  };
  return evidence(x.best().columns) - evidence(columns_without(x, term.columns));
}

/// A term below the materiality floor is a cause only if it brings as much evidence as a pliable law must.
bool is_cause_though_small(const Examination& x, double size, double evidence) {
  return size >= kLeastSize && evidence_beyond_model_error(evidence - kUnknownCost, size) >=
                                   x.id.options.small_pliable_evidence / std::sqrt(size);
}

/// The unknown terms of the best set that are sure enough: causes, or small effects below the materiality
/// floor.
void name_unknowns(const Examination& x, const Inclusion& inclusion, Names& names) {
  if (x.best().unknowns.empty()) return;
  const BoxedFit nothing = fit_within_calibration(x.id);
  for (int u : x.best().unknowns) {
    const UnknownTerm& term = x.id.equations.unknowns[static_cast<std::size_t>(u)];
    const double probability = inclusion.of_any(of_same_channel(x.id.equations, term.label)),
                 share = share_lost(x, nothing, term.columns), size = size_of(x, term),
                 evidence = evidence_of(x, term);
    names.sizes.greatest = std::max(names.sizes.greatest, size);
    if (probability < kLeastProbabilityNamed || share < kLeastUnknownShare) continue;
    const double stated = std::min(names.surest, probability);
    const SmallEffect small{"unknown, " + term.label, stated, evidence, size};
    if (size < 1 && !is_cause_though_small(x, size, evidence)) {
      names.small_unknowns.push_back(small);
      continue;
    }
    names.unknowns.push_back({.depends_on = term.label, .probability = stated, .share = share});
    names.sizes.of_names.push_back(small);
  }
  std::ranges::stable_sort(names.unknowns, std::ranges::greater{}, &UnknownCause::share);
}

/// How far a form of the best set is from the textbook's, in sigmas of what its prior lets the data find.
double form_sigmas(const Posterior& posterior, Eigen::Index at) {
  const double found = kFormSpread * kFormSpread - posterior.covariance(at, at);
  return found > 0 ? std::abs(posterior.mean[at]) / std::sqrt(found) : 0.0;
}

/// Whether the law's strength varies with the variable by more than laws do, or surely by more than a fifth.
bool is_inexact_form(const Posterior& posterior, Eigen::Index at) {
  return form_sigmas(posterior, at) >= kInexactForm ||
         std::abs(posterior.mean[at]) - kNormal95 * std::sqrt(posterior.covariance(at, at)) >= kSureForm;
}

/// Whether the form's variable differs within these runs: a payload that all of them carry is the law's size.
bool form_is_told(const Examination& x, int form) {
  const Column& column = x.id.equations.columns[static_cast<std::size_t>(form)];
  const auto part = static_cast<std::size_t>(column.part) / kFormVariables.size();
  const int law = x.id.equations.columns_of_candidate(column.owner, false)[part];
  const auto& gram = x.id.problem.gram;
  return std::abs(gram(law, form)) < kSameSignature * std::sqrt(gram(law, law) * gram(form, form));
}

/// A named law whose strength varies with a variable by more than inexact forms do is not the whole cause.
/// At the battery alone forms take up the power's curvature and say nothing.
void name_inexact_forms(const Examination& x, Names& names) {
  if (std::ranges::none_of(x.id.signals, measures_motors)) return;
  const Equations& equations = x.id.equations;
  const std::vector<int>& columns = x.best().columns;
  const Posterior posterior = solve(x.id.problem, columns, x.id.dispersion);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = equations.columns[static_cast<std::size_t>(columns[k])];
    if (column.kind != Column::Kind::form) continue;
    const std::string law = equations.candidates[static_cast<std::size_t>(column.owner)].label();
    const bool named = std::ranges::any_of(
        names.named, [&](const ActiveEffect& effect) { return effect.candidate.label() == law; });
    if (!named || !form_is_told(x, columns[k])) continue;
    if (!is_inexact_form(posterior, static_cast<Eigen::Index>(k))) continue;
    const double share = share_lost(x, fit_within_calibration(x.id), {columns[k]});
    if (share < kLeastShownShare) continue;
    const auto variable = static_cast<std::size_t>(column.part) % kFormVariables.size();
    names.unknowns.push_back({.depends_on = std::string(kFormVariables[variable]) + " (" + law + ")",
                              .probability = names.surest,
                              .share = share});
  }
}

/// Marginal inclusion, averaged over searches that each leave the runs of one fold out. Sets with effects
/// below the materiality floor count: what they explain does not need a larger effect.
Inclusion inclusion_of(const Examination& x) {
  const Identification& id = x.id;
  SearchOptions options = id.options;
  options.small_effect_evidence = std::numeric_limits<double>::infinity();
  Inclusion inclusion;
  if (x.runs.fold_of.empty()) {
    inclusion.add(id.equations, search_explanations(id.problem, id.equations, options));
    return inclusion;
  }
  const std::size_t folds = fold_count(x.runs);
  for (std::size_t fold = 0; fold < folds; ++fold) {
    const LinearProblem problem = without_calibration(id.equations, fitted_runs(x.runs, fold), id.dispersion);
    inclusion.add(id.equations, search_explanations(problem, id.equations, options),
                  1.0 / static_cast<double>(folds));
  }
  return inclusion;
}

/// Size of an effect of the best set over the materiality floor; infinite where the set lacks it.
double size_of(const Examination& x, const std::string& label) {
  for (std::size_t k = 0; k < x.best().size.size(); ++k)
    if (x.id.equations.candidates[static_cast<std::size_t>(x.best().candidates[k])].label() == label)
      return x.best().size[k];
  return std::numeric_limits<double>::infinity();
}

/// Whether an effect is one of the best set that is listed, not named.
bool is_small(const Examination& x, const std::string& label) {
  return std::ranges::any_of(x.best().small, [&](int c) {
    return x.id.equations.candidates[static_cast<std::size_t>(c)].label() == label;
  });
}

}  // namespace

double probability_of(const Names& names, const ActiveEffect& effect) {
  const auto found = names.probabilities.find(effect.candidate.label());
  return found == names.probabilities.end() ? 0.0 : std::min(names.surest, found->second);
}

Names choose_names(const Examination& x) {
  const Inclusion inclusion = inclusion_of(x);
  Names names{.probabilities = inclusion.of_each(), .something = inclusion.of_something()};
  names.surest = x.runs.diagnosis.runs.size() < kRunsForSmallEffects ? kSurestOfFewRuns : kSurest;
  for (double size : x.best().size) names.sizes.greatest = std::max(names.sizes.greatest, size);
  name_unknowns(x, inclusion, names);
  for (const UnknownTerm& term : x.id.equations.unknowns) names.probabilities.erase(term.label);
  share_probabilities(x, inclusion, names);
  for (const ActiveEffect& effect : x.id.state.effects) {
    const std::string label = effect.candidate.label();
    if (is_small(x, label)) continue;
    std::set<std::string> group{label};
    if (const auto others = names.stand_ins.find(label); others != names.stand_ins.end())
      group.insert(others->second.begin(), others->second.end());
    // A group of half the catalog tells nothing apart.
    if (group.size() > kMostMembers || inclusion.of_any(group) < kLeastProbabilityNamed) continue;
    names.named.push_back(effect);
    names.sizes.of_names.push_back({label, probability_of(names, effect),
                                    evidence_for(x.id.equations, x.id.explanations, label),
                                    size_of(x, label)});
  }
  name_inexact_forms(x, names);
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
