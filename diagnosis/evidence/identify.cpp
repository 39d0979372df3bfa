#include "diagnosis/evidence/identify.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/delay_search.hpp"
#include "diagnosis/evidence/groups.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/evidence/region_search.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0503-evidence.md
// Method: [MacKay1992]
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

/// Effects of the best set of all that are not large enough to matter, nor beyond doubt.
std::vector<SmallEffect> small_effects(const Equations& equations,
                                       const std::vector<Explanation>& explanations) {
  const Explanation& best = explanations.front();
  std::vector<SmallEffect> small;
  if (best.small.empty()) return small;
  Inclusion inclusion;
  inclusion.add(equations, explanations);
  for (std::size_t k = 0; k < best.candidates.size(); ++k) {
    if (std::ranges::count(best.small, best.candidates[k]) == 0) continue;
    const std::string label = equations.candidates[static_cast<std::size_t>(best.candidates[k])].label();
    const double probability = inclusion.of(label);
    if (probability < kLeastProbabilityNamed) continue;
    small.push_back({label, probability, evidence_for(equations, explanations, label), best.size[k]});
  }
  return small;
}

/// No effect but the rough delay of the electrical channels, where the logs show one.
ModelState first_state(const LogSet& logs, std::size_t nuisances, const std::set<std::string>& without) {
  ModelState state;
  state.nuisance_fraction.assign(nuisances, 0.0);
  const double delay_s = rough_channel_delay_s(logs);
  if (delay_s == 0) return state;
  const std::vector<Candidate> candidates = catalog_candidates(logs.dataset->robot, without);
  const auto delay = std::ranges::find_if(
      candidates, [](const Candidate& candidate) { return candidate.effect().delays_channels; });
  if (delay != candidates.end()) state.effects.push_back({*delay, {delay_s}});
  return state;
}

/// Whether the battery's power is all that the runs have of the energy; it is quadratic in the torque. About
/// the nominal model the curvature of one large effect looks like a winding and a driver error beside it.
/// Linearized about all three, the search finds them again.
bool sees_battery_alone(const std::vector<RunSignals>& signals) {
  return std::ranges::none_of(signals, measures_motors) && std::ranges::any_of(signals, measures_energy);
}

/// Linearizes about the state and searches the sets of effects and unknown terms, of `most` members.
void search_about_state(const LogSet& logs, const std::set<std::string>& without, const NoiseModel* noise,
                        int most, std::map<std::string, double>& known, Identification& id) {
  const Robot& robot = logs.dataset->robot;
  const std::vector<std::size_t> runs = every(logs.runs.size());
  const std::vector<Candidate> regions =
      region_candidates(id.signals, robot, id.nuisances, id.state, without);
  id.equations = build_equations(id.signals, robot, id.nuisances, id.state, regions,
                                 {.first_noise = noise, .without = without});
  id.dispersion = run_dispersion(id.equations, rich_columns(id.equations));
  id.problem = without_calibration(id.equations, runs, id.dispersion);
  scale_unknowns(id.equations, id.problem, columns_of(id.equations, id.state), id.dispersion);
  id.options = search_options(
      id.dispersion, runs.size(),
      least_amplitudes(id.signals, robot, id.nuisances, id.state, id.equations.candidates, known));
  id.options.most_members = most;
  id.explanations = search_explanations(id.problem, id.equations, id.options);
  id.below_materiality = small_effects(id.equations, id.explanations);
  erase_immaterial(id.explanations);
}

/// The state of the best set, refitted without the linearization.
void adopt_best(const LogSet& logs, Identification& id) {
  const std::vector<std::size_t> runs = every(logs.runs.size());
  const Explanation& best = id.explanations.front();
  const Eigen::VectorXd parameters = fit_parameters(id.equations, runs, best.columns, id.dispersion);
  Refit fitted =
      refit(logs, runs, id.nuisances, adopt(id.equations, id.nuisances, id.state, best, parameters),
            id.equations.noise, id.equations.run_variance, id.dispersion, unknown_labels(id.equations, best));
  id.state = std::move(fitted.state);
  id.signals = std::move(fitted.signals);
}

/// Whether the best set is that about which the model is linearized.
bool is_settled(const Identification& id) {
  return labels_of(id.equations, id.explanations.front()) == labels_of(id.state);
}

/// Takes the best set over and searches about it again, until the set stays. Returns whether it does.
bool converge(const LogSet& logs, const std::set<std::string>& without, std::map<std::string, double>& known,
              Identification& id) {
  for (int round = 0; round < kRelinearizations; ++round) {
    adopt_best(logs, id);
    const NoiseModel noise = id.equations.noise;
    search_about_state(logs, without, &noise, kMostMembers, known, id);
    if (is_settled(id)) return true;
  }
  adopt_best(logs, id);  // the last answer, refitted
  return false;
}

/// The best single law, first of all sets. Returns whether there is one.
bool prefer_single_law(std::vector<Explanation>& explanations) {
  const auto law = std::ranges::find_if(
      explanations, [](const Explanation& e) { return e.unknowns.empty() && e.candidates.size() == 1; });
  if (law == explanations.end()) return false;
  std::rotate(explanations.begin(), law, law + 1);
  return true;
}

}  // namespace

Identification identify(const LogSet& logs, const std::set<std::string>& without) {
  Identification id{.nuisances = calibration_nuisances(logs.dataset->robot)};
  id.state = first_state(logs, id.nuisances.size(), without);
  id.signals = read_signals(logs, channel_delay_s(id.state));
  std::map<std::string, double> known;
  const bool battery_alone = sees_battery_alone(id.signals);
  search_about_state(logs, without, nullptr, battery_alone ? 1 : kMostMembers, known, id);
  Identification about_law = id;
  const bool no_law_found = id.explanations.front().candidates.empty() && is_settled(id) && !battery_alone;
  if (!no_law_found) converge(logs, without, known, id);
  if (id.explanations.front().unknowns.empty() || !prefer_single_law(about_law.explanations)) return id;
  const bool settles = converge(logs, without, known, about_law);
  const Explanation& laws = about_law.explanations.front();
  return settles && laws.unknowns.empty() && !laws.candidates.empty() ? about_law : id;
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
