#include "diagnosis/evidence/groups.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

constexpr double kNegligibleScore = 40;  ///< log units below the best: e^-40 of its weight

std::multiset<std::string> members_of(const Equations& equations, const Explanation& explanation) {
  std::multiset<std::string> labels;
  for (int c : explanation.candidates)
    labels.insert(equations.candidates[static_cast<std::size_t>(c)].label());
  for (int u : explanation.unknowns) labels.insert(equations.unknowns[static_cast<std::size_t>(u)].label);
  return labels;
}

/// Fit of an explanation's laws as the catalog has them, amplitudes free of any prior: what the data alone
/// say.
struct FreeFit {
  std::vector<int> columns{};
  Posterior posterior{};
};

FreeFit free_fit(const LinearProblem& problem, const Equations& equations, const Explanation& explanation,
                 double dispersion) {
  FreeFit fit;
  for (int k : explanation.columns)
    if (equations.columns[static_cast<std::size_t>(k)].kind != Column::Kind::form) fit.columns.push_back(k);
  LinearProblem free = problem;
  for (int k : fit.columns)
    if (equations.columns[static_cast<std::size_t>(k)].kind == Column::Kind::amplitude)
      free.prior_sd[k] *= kFreeAmplitude;
  fit.posterior = solve(free, fit.columns, dispersion);
  return fit;
}

/// Whether a fit's amplitude of an explanation's effect is one that the catalog accepts, or within two
/// standard deviations of one.
bool is_accepted(const FreeFit& fit, const Equations& equations, const Explanation& explanation,
                 const std::string& label, const Robot& robot) {
  for (int c : explanation.candidates) {
    const Candidate& candidate = equations.candidates[static_cast<std::size_t>(c)];
    if (candidate.label() != label) continue;
    std::vector<double> amplitude;
    double variance = 0;
    for (int k : equations.columns_of_candidate(c, false)) {
      const Eigen::Index at = std::find(fit.columns.begin(), fit.columns.end(), k) - fit.columns.begin();
      amplitude.push_back(fit.posterior.mean[at]);
      variance += fit.posterior.covariance(at, at);
    }
    return outside_range(candidate, amplitude, robot) <= kSigmasOutOfRange * std::sqrt(variance);
  }
  return false;
}

/// Calls use(explanation, label) for each explanation with one other effect, `label`, in the place of a
/// candidate of the best one.
template <class Use>
void for_each_rival(const Equations& equations, const std::vector<Explanation>& explanations, int candidate,
                    Use&& use) {
  if (explanations.empty()) return;
  const Explanation& best = explanations.front();
  const std::string label = equations.candidates[static_cast<std::size_t>(candidate)].label();
  std::multiset<std::string> rest = members_of(equations, best);
  rest.erase(rest.find(label));
  for (const Explanation& e : explanations) {
    if (e.candidates.size() != best.candidates.size() || e.unknowns != best.unknowns) continue;
    std::multiset<std::string> other = members_of(equations, e);
    if (other.contains(label) || !std::includes(other.begin(), other.end(), rest.begin(), rest.end()))
      continue;
    for (const std::string& kept : rest) other.erase(other.find(kept));
    if (other.size() == 1) use(e, *other.begin());
  }
}

}  // namespace

void Inclusion::add(const Equations& equations, const std::vector<Explanation>& explanations, double weight) {
  const double top = explanations.empty() ? 0.0 : explanations.front().score;
  std::map<std::multiset<std::string>, const Explanation*> best_of_set;  // shapes of one effect count once
  for (const Explanation& e : explanations) {
    if (kScoreFlattening * (top - e.score) > kNegligibleScore) continue;
    const auto [at, fresh] = best_of_set.try_emplace(members_of(equations, e), &e);
    if (!fresh && e.score > at->second->score) at->second = &e;
  }
  double total = 0;
  for (const auto& [labels, e] : best_of_set) total += std::exp(kScoreFlattening * (e->score - top));
  for (const auto& [labels, e] : best_of_set)
    sets_.push_back({.labels = {labels.begin(), labels.end()},
                     .weight = weight * std::exp(kScoreFlattening * (e->score - top)) / total,
                     .matters = !e->unknowns.empty() ||
                                std::ranges::any_of(e->size, [](double size) { return size >= 1; })});
}

double Inclusion::of_any(const std::set<std::string>& labels) const {
  double sum = 0;
  for (const WeightedSet& set : sets_)
    if (std::ranges::any_of(labels, [&](const std::string& label) { return set.labels.contains(label); }))
      sum += set.weight;
  return std::min(1.0, sum);
}

double Inclusion::of_something() const {
  double sum = 0;
  for (const WeightedSet& set : sets_) sum += set.matters ? set.weight : 0.0;
  return std::min(1.0, sum);
}

std::map<std::string, double> Inclusion::of_each() const {
  std::map<std::string, double> probability;
  for (const WeightedSet& set : sets_)
    for (const std::string& label : set.labels)
      probability[label] = std::min(1.0, probability[label] + set.weight);
  return probability;
}

double evidence_for(const Equations& equations, const std::vector<Explanation>& explanations,
                    const std::string& label) {
  const auto without = std::ranges::find_if(explanations, [&](const Explanation& e) {  // the best one first
    return std::ranges::none_of(e.candidates, [&](int c) {
      return equations.candidates[static_cast<std::size_t>(c)].label() == label;
    });
  });
  return without == explanations.end() ? 0.0 : explanations.front().score - without->score;
}

std::vector<StandIn> stand_ins(const LinearProblem& problem, const Equations& equations,
                               const std::vector<Explanation>& explanations, int candidate, double dispersion,
                               const Robot& robot) {
  if (explanations.empty()) return {};
  const double own_loss = free_fit(problem, equations, explanations.front(), dispersion).posterior.loss;
  std::vector<StandIn> found;
  std::size_t rivals = 0;
  for_each_rival(equations, explanations, candidate, [&](const Explanation& e, const std::string& label) {
    if (++rivals > kMostRivals) return;
    const FreeFit fit = free_fit(problem, equations, e, dispersion);
    const double loss_more = fit.posterior.loss - own_loss;
    if (loss_more > kStandInLoss || !is_accepted(fit, equations, e, label, robot)) return;
    const auto known =
        std::find_if(found.begin(), found.end(), [&](const StandIn& s) { return s.label == label; });
    if (known == found.end())
      found.push_back({label, loss_more});
    else
      known->loss_more = std::min(known->loss_more, loss_more);
  });
  return found;
}

double likelihood_over_named(const StandIn& other) {
  return std::exp(-0.5 * kScoreFlattening * std::max(0.0, other.loss_more));
}

std::vector<StandIn> likely_rivals(const Equations& equations, const std::vector<Explanation>& explanations,
                                   int candidate, const Inclusion& inclusion,
                                   const std::vector<StandIn>& stand_ins) {
  std::set<std::string> group{equations.candidates[static_cast<std::size_t>(candidate)].label()};
  double weight = 1;
  for (const StandIn& other : stand_ins) {
    group.insert(other.label);
    weight += likelihood_over_named(other);
  }
  const double own = inclusion.of_any(group) / weight;
  std::vector<StandIn> rivals;
  for_each_rival(equations, explanations, candidate, [&](const Explanation&, const std::string& label) {
    if (group.contains(label) || inclusion.of(label) <= 0 ||
        std::ranges::count(rivals, label, &StandIn::label) > 0)
      return;
    rivals.push_back({label, 2 / kScoreFlattening * std::log(own / inclusion.of(label))});
  });
  std::ranges::stable_sort(rivals, std::ranges::less{}, &StandIn::loss_more);
  rivals.resize(std::min(rivals.size(), kMostLikelyRivals));
  std::size_t taken = 0;
  while (inclusion.of_any(group) < kLeastProbabilityNamed && taken < rivals.size())
    group.insert(rivals[taken++].label);
  rivals.resize(inclusion.of_any(group) < kLeastProbabilityNamed ? 0 : taken);
  return rivals;
}

std::string pinned_combination(const LinearProblem& problem, const Equations& equations,
                               const Explanation& best, const std::string& label, const std::string& other,
                               double dispersion) {
  int other_candidate = -1, own = -1;
  for (std::size_t c = 0; c < equations.candidates.size() && other_candidate < 0; ++c)
    if (equations.candidates[c].label() == other) other_candidate = static_cast<int>(c);
  for (int c : best.candidates)
    if (equations.candidates[static_cast<std::size_t>(c)].label() == label) own = c;
  if (other_candidate < 0 || own < 0) return {};
  std::vector<int> columns = best.columns;
  const int a = equations.columns_of_candidate(own, false).front();
  const int b = equations.columns_of_candidate(other_candidate, false).front();
  columns.push_back(b);
  const Posterior posterior = solve(problem, columns, dispersion);
  const auto at = [&](int column) {
    return std::find(columns.begin(), columns.end(), column) - columns.begin();
  };
  const Eigen::Index i = at(a), j = at(b);
  const double sa = equations.candidates[static_cast<std::size_t>(own)].step[0];
  const double sb = equations.candidates[static_cast<std::size_t>(other_candidate)].step[0];
  Eigen::Matrix2d covariance;
  covariance << posterior.covariance(i, i) / (sa * sa), posterior.covariance(i, j) / (sa * sb),
      posterior.covariance(i, j) / (sa * sb), posterior.covariance(j, j) / (sb * sb);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  Eigen::Vector2d direction = solver.eigenvectors().col(0);
  if (std::abs(direction[0]) < 1e-6) return {};
  const double k = direction[1] / direction[0] * sa / sb;
  char text[256];
  std::snprintf(text, sizeof text, "%s %s %+.4g * %s %s = %.4g", label.c_str(),
                equations.candidates[static_cast<std::size_t>(own)].amplitude[0].c_str(), k, other.c_str(),
                equations.candidates[static_cast<std::size_t>(other_candidate)].amplitude[0].c_str(),
                posterior.mean[i] + k * posterior.mean[j]);
  return text;
}

}  // namespace joulepath
