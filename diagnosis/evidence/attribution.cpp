#include "diagnosis/evidence/attribution.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0504-small-effects-and-groups.md
namespace joulepath {
namespace {

/// Whether no amplitude that is nonnegative in physics is negative.
bool signs_hold(const Equations& equations, const std::vector<int>& columns, const Eigen::VectorXd& mean) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = equations.columns[static_cast<std::size_t>(columns[k])];
    if (column.kind == Column::Kind::amplitude &&
        equations.candidates[static_cast<std::size_t>(column.owner)].nonnegative &&
        mean[static_cast<Eigen::Index>(k)] < 0)
      return false;
  }
  return true;
}

/// Amplitude of each candidate of an explanation, as a multiple of the just material amplitude.
std::vector<double> sizes_of(const Equations& equations, const Explanation& explanation,
                             const Eigen::VectorXd& mean, const std::vector<double>& least_amplitude) {
  std::vector<double> sizes;
  for (int c : explanation.candidates) {
    double square = 0;
    for (std::size_t k = 0; k < explanation.columns.size(); ++k) {
      const Column& column = equations.columns[static_cast<std::size_t>(explanation.columns[k])];
      if (column.owner == c && column.kind == Column::Kind::amplitude)
        square += mean[static_cast<Eigen::Index>(k)] * mean[static_cast<Eigen::Index>(k)];
    }
    sizes.push_back(std::sqrt(square) / least_amplitude[static_cast<std::size_t>(c)]);
  }
  return sizes;
}

/// Whether a law's part is no more than what the set explains: a law and an unknown term of nearly opposite
/// signatures would cancel each other, and lend the law's form a freedom out of proportion.
bool parts_hold(const LinearProblem& problem, const Equations& equations, const Explanation& explanation,
                const Eigen::VectorXd& mean, double explained) {
  if (explanation.unknowns.empty()) return true;
  for (int c : explanation.candidates) {
    double square = 0;
    for (std::size_t i = 0; i < explanation.columns.size(); ++i)
      for (std::size_t j = 0; j < explanation.columns.size(); ++j) {
        const int a = explanation.columns[i], b = explanation.columns[j];
        const Column &one = equations.columns[static_cast<std::size_t>(a)],
                     &two = equations.columns[static_cast<std::size_t>(b)];
        if (one.owner == c && two.owner == c && one.kind == Column::Kind::amplitude &&
            two.kind == Column::Kind::amplitude)
          square +=
              mean[static_cast<Eigen::Index>(i)] * mean[static_cast<Eigen::Index>(j)] * problem.gram(a, b);
      }
    if (square > kLargestPart * explained) return false;
  }
  return true;
}

/// Log odds against a set: what it takes to add a law or an unknown term.
double cost_of(const Explanation& explanation, const std::vector<double>& cost_of_unknown) {
  const auto laws = static_cast<double>(explanation.candidates.size());
  double cost = laws > 0 ? kEffectCost + (laws - 1) * kFurtherEffectCost : 0.0;
  for (int u : explanation.unknowns) cost += cost_of_unknown[static_cast<std::size_t>(u)];
  return cost;
}

/// Laws are inexact, and where a law acts a smooth curve always fits a little better. Each unknown term costs
/// the least share that is reported of the log evidence that it brings alone: to replace or refine a law it
/// must add more than that, and where no law acts it loses that share.
std::vector<double> costs_of_unknowns(const LinearProblem& problem, const Equations& equations,
                                      double dispersion) {
  std::vector<double> costs;
  for (const UnknownTerm& term : equations.unknowns) {
    const double loss = solve(problem, term.columns, dispersion, false).loss;
    costs.push_back(kUnknownCost + kLeastUnknownShare * 0.5 * (problem.residual_square / dispersion - loss));
  }
  return costs;
}

Explanation evaluate(const LinearProblem& problem, const Equations& equations, std::vector<int> candidates,
                     std::vector<int> unknowns, const SearchOptions& options, double empty_evidence) {
  Explanation explanation{.candidates = std::move(candidates), .unknowns = std::move(unknowns)};
  for (int c : explanation.candidates)
    for (int k : equations.columns_of_candidate(c, true)) explanation.columns.push_back(k);
  for (int u : explanation.unknowns)
    for (int k : equations.unknowns[static_cast<std::size_t>(u)].columns) explanation.columns.push_back(k);
  Posterior posterior = solve(problem, explanation.columns, options.dispersion, false);
  const double explained = problem.residual_square - options.dispersion * posterior.loss;
  const double cost = cost_of(explanation, options.cost_of_unknown);
  explanation.score = posterior.log_evidence - empty_evidence - cost;
  explanation.loss = posterior.loss;
  if (!options.least_amplitude.empty()) {
    explanation.size = sizes_of(equations, explanation, posterior.mean, options.least_amplitude);
    for (std::size_t k = 0; k < explanation.size.size(); ++k)
      if (explanation.size[k] < 1) explanation.small.push_back(explanation.candidates[k]);
  }
  if (!signs_hold(equations, explanation.columns, posterior.mean) ||
      !parts_hold(problem, equations, explanation, posterior.mean, explained))
    explanation.score = -1e300;
  explanation.mean = std::move(posterior.mean);
  return explanation;
}

double evidence_needed(const Candidate& candidate, double size, const SearchOptions& options) {
  if (candidate.effect().info.pliability != Pliability::firm)
    return options.small_pliable_evidence / std::sqrt(size);
  return options.small_effect_evidence;
}

/// Score that a candidate adds to a set.
double score_added(const LinearProblem& problem, const Equations& equations, const Explanation& explanation,
                   int candidate, const SearchOptions& options, double empty_evidence) {
  std::vector<int> others = explanation.candidates;
  others.erase(std::ranges::find(others, candidate));
  return explanation.score -
         evaluate(problem, equations, std::move(others), explanation.unknowns, options, empty_evidence).score;
}

/// What a candidate's evidence is above what it takes to name it; below 0: it is not named. Any is enough at
/// the materiality floor and above, below it alone it must add a minimum.
/// Inexact forms of a large effect bring a small share of its evidence, so the minimum includes that share,
/// in proportion to the part of the signature that the other effects can reproduce. A small delay is a
/// convention: a log's stamp may be at a sample's beginning, middle or end.
double spare_evidence(const LinearProblem& problem, const Equations& equations,
                      const Explanation& explanation, int candidate, const SearchOptions& options,
                      double empty_evidence) {
  const double added = score_added(problem, equations, explanation, candidate, options, empty_evidence);
  if (std::ranges::count(explanation.small, candidate) == 0) return added;
  const double size = explanation.size[static_cast<std::size_t>(
      std::ranges::find(explanation.candidates, candidate) - explanation.candidates.begin())];
  const Candidate& law = equations.candidates[static_cast<std::size_t>(candidate)];
  if (size < kLeastSize || law.effect().delays_channels) return -std::numeric_limits<double>::infinity();
  const double needed =
      evidence_needed(law, size, options) + ghost_share(problem, equations, explanation, candidate) *
                                                kShareOfFormError * std::max(0.0, explanation.score);
  return evidence_beyond_model_error(added, size) - needed;
}

std::vector<int> indices(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

void insert_sorted(std::vector<int>& set, int member) {
  set.insert(std::upper_bound(set.begin(), set.end(), member), member);
}

bool has_name(const Equations& equations, const std::vector<int>& set, int candidate) {
  for (int member : set)
    if (equations.candidates[static_cast<std::size_t>(member)].label() ==
        equations.candidates[static_cast<std::size_t>(candidate)].label())
      return true;
  return false;
}

/// What may join an explanation: candidates by their index, then unknown terms.
std::vector<int> members_to_add(const Equations& equations, const Explanation& from,
                                const SearchOptions& options) {
  std::vector<int> members;
  const int laws = static_cast<int>(equations.candidates.size());
  if (std::ssize(from.candidates) < options.most_effects)
    for (int c = 0; c < laws; ++c)
      if ((options.allowed.empty() || std::ranges::count(options.allowed, c) > 0) &&
          !has_name(equations, from.candidates, c))
        members.push_back(c);
  if (std::ssize(from.unknowns) < kMostUnknowns)
    for (int u = 0; u < static_cast<int>(equations.unknowns.size()); ++u)
      if (std::ranges::count(from.unknowns, u) == 0) members.push_back(laws + u);
  return members;
}

/// Each set of the beam with one more member, not yet evaluated; sets seen before are left out.
std::vector<Explanation> grown_by_one(const Equations& equations, const std::vector<Explanation>& beam,
                                      const SearchOptions& options, std::set<std::vector<int>>& seen) {
  std::vector<Explanation> grown;
  const int laws = static_cast<int>(equations.candidates.size());
  for (const Explanation& from : beam)
    for (int member : members_to_add(equations, from, options)) {
      Explanation next{.candidates = from.candidates, .unknowns = from.unknowns};
      member < laws ? insert_sorted(next.candidates, member) : insert_sorted(next.unknowns, member - laws);
      std::vector<int> key = next.candidates;
      for (int u : next.unknowns) key.push_back(laws + u);
      if (seen.insert(key).second) grown.push_back(std::move(next));
    }
  return grown;
}

void sort_by_score(std::vector<Explanation>& explanations) {
  std::ranges::stable_sort(explanations, std::ranges::greater{}, &Explanation::score);
}

}  // namespace

double evidence_beyond_model_error(double evidence, double size) {
  const double most = 0.5 * size * size / (kModelError * kModelError);
  return evidence > 0 ? evidence * most / (evidence + most) : evidence;
}

double ghost_share(const LinearProblem& problem, const Equations& equations, const Explanation& explanation,
                   int candidate) {
  const EffectInfo& info = equations.candidates[static_cast<std::size_t>(candidate)].effect().info;
  if (info.pliability == Pliability::anywhere) return 1.0;
  const std::vector<int> of_candidate = equations.columns_of_candidate(candidate, true);
  std::vector<int> others;
  std::ranges::copy_if(explanation.columns, std::back_inserter(others),
                       [&](int k) { return std::ranges::count(of_candidate, k) == 0; });
  if (others.empty()) return 0.0;
  const auto n = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd gram(n, n);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i)
    scale[i] = 1 / std::sqrt(std::max(1e-300, problem.gram(others[std::size_t(i)], others[std::size_t(i)])));
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      gram(i, j) = scale[i] * scale[j] * problem.gram(others[std::size_t(i)], others[std::size_t(j)]);
  gram.diagonal().array() += kOverlapRidge;
  const Eigen::LDLT<Eigen::MatrixXd> factor(gram);
  double most = 0;
  for (int column : equations.columns_of_candidate(candidate, false)) {
    Eigen::VectorXd shared(n);
    for (Eigen::Index i = 0; i < n; ++i) shared[i] = scale[i] * problem.gram(others[std::size_t(i)], column);
    const double own = problem.gram(column, column);
    if (own > 0) most = std::max(most, shared.dot(factor.solve(shared)) / own);
  }
  return std::clamp(most / kFullOverlap, 0.0, 1.0);
}

SearchOptions search_options(double dispersion, std::size_t runs, std::vector<double> least_amplitude) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const bool few = runs < kRunsForSmallEffects;
  return {.dispersion = dispersion,
          .least_amplitude = std::move(least_amplitude),
          .small_effect_evidence = few ? kSmallEffectEvidenceOfFewRuns : kSmallEffectEvidence,
          .small_pliable_evidence = few ? kNever : kSmallPliableEvidence};
}

std::vector<Explanation> search_explanations(const LinearProblem& problem, const Equations& equations,
                                             const SearchOptions& asked) {
  SearchOptions options = asked;
  options.cost_of_unknown = costs_of_unknowns(problem, equations, options.dispersion);
  const double empty_evidence = solve(problem, {}, options.dispersion, false).log_evidence;
  std::vector<Explanation> met{evaluate(problem, equations, {}, {}, options, empty_evidence)};
  std::vector<Explanation> beam = met;
  std::set<std::vector<int>> seen;
  for (int depth = 0; depth < options.most_members; ++depth) {
    std::vector<Explanation> next = grown_by_one(equations, beam, options, seen);
    parallel_for(next.size(), [&](std::size_t k) {
      next[k] = evaluate(problem, equations, next[k].candidates, next[k].unknowns, options, empty_evidence);
    });
    std::erase_if(next, [](const Explanation& e) { return e.score < -1e200; });
    sort_by_score(next);
    const std::ptrdiff_t width = depth == 0 ? std::ssize(next) : kBeamWidth;  // every pair is solved
    beam.assign(next.begin(), next.begin() + std::min(width, std::ssize(next)));
    met.insert(met.end(), next.begin(), next.end());
  }
  sort_by_score(met);
  if (std::isfinite(options.small_effect_evidence))
    parallel_for(std::min(met.size(), kMostReconsidered), [&](std::size_t k) {
      std::erase_if(met[k].small, [&](int candidate) {
        return spare_evidence(problem, equations, met[k], candidate, options, empty_evidence) >= 0;
      });
    });
  return met;
}

std::optional<int> weakest_member(const LinearProblem& problem, const Equations& equations,
                                  const SearchOptions& asked) {
  SearchOptions options = asked;
  options.cost_of_unknown = costs_of_unknowns(problem, equations, options.dispersion);
  const double empty_evidence = solve(problem, {}, options.dispersion, false).log_evidence;
  const Explanation whole = evaluate(problem, equations, indices(equations.candidates.size()),
                                     indices(equations.unknowns.size()), options, empty_evidence);
  std::optional<int> weakest;
  double least = 0;
  for (int c : whole.candidates) {
    const double spare = spare_evidence(problem, equations, whole, c, options, empty_evidence);
    if (spare < least) least = spare, weakest = c;
  }
  return weakest;
}

void erase_immaterial(std::vector<Explanation>& explanations) {
  const bool keeps_best = !explanations.empty() && explanations.front().has_material();
  std::erase_if(explanations,
                [&](const Explanation& e) { return !e.small.empty() && !(keeps_best && e.has_material()); });
}

void scale_unknowns(Equations& equations, LinearProblem& problem, const std::vector<int>& known,
                    double dispersion) {
  for (const UnknownTerm& term : equations.unknowns) {
    std::vector<int> columns = known;
    columns.insert(columns.end(), term.columns.begin(), term.columns.end());
    const Eigen::VectorXd widest = problem.prior_sd;
    double best_width = 1, best = -1e300;
    for (double width : {1.0, 0.3, 0.1, 0.03, 0.01}) {
      for (int k : term.columns) problem.prior_sd[k] = width * widest[k];
      const double evidence = solve(problem, columns, dispersion, false).log_evidence;
      if (evidence > best) best = evidence, best_width = width;
    }
    for (int k : term.columns) equations.prior_sd[k] = problem.prior_sd[k] = best_width * widest[k];
  }
}

}  // namespace joulepath
