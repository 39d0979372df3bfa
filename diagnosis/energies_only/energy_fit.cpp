#include "diagnosis/energies_only/energy_fit.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

constexpr int kIterations = 3;
constexpr int kNoiseRounds = 4;

/// Energies do not contain the place on the floor, the time of day and the sample of an event.
std::set<std::string> beyond_energies(const std::vector<EnergyRun>& runs) {
  const bool dated =
      std::ranges::all_of(runs, [](const EnergyRun& run) { return run.motion.signals.time_of_day_known; });
  std::set<std::string> names;
  for (const EffectDescription& effect : effect_catalog()) {
    const Needs& needs = effect.info.needs;
    if (needs.samples || (needs.time_of_day && !dated)) names.emplace(effect.info.name);
  }
  return names;
}

Eigen::VectorXd no_doubts() { return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kMotionDoubts.size())); }

void find_visible(EnergyProblem& problem) {
  const Equations& equations = problem.equations;
  const LinearProblem rest = without_calibration(equations, every(problem.runs.size()));
  std::set<std::string> seen;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    double sigmas = 0;
    for (int k : equations.columns_of_candidate(static_cast<int>(c), false))
      sigmas = std::max(sigmas, std::sqrt(std::max(0.0, rest.gram(k, k))) * rest.prior_sd[k]);
    const std::string label = equations.candidates[c].label();
    if (sigmas > kVisibleSigmas)
      problem.visible.push_back(static_cast<int>(c)), seen.insert(label);
    else
      problem.hidden.insert(label);
  }
  for (const std::string& label : seen) problem.hidden.erase(label);
}

/// Amplitude of each candidate that changes the runs' energy by a material amount.
std::vector<double> least_amplitudes(const EnergyProblem& problem) {
  const Equations& equations = problem.equations;
  const LinearProblem all = sum_runs(equations.runs, every(problem.runs.size()), equations.prior_sd);
  std::vector<double> least;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    const int k = equations.columns_of_candidate(static_cast<int>(c), false).front();
    const double per_amplitude =
        problem.noise.sum * std::sqrt(all.gram(k, k) / static_cast<double>(problem.runs.size()));
    least.push_back(per_amplitude > 0 ? kMaterialEnergy / per_amplitude : 1e300);
  }
  return least;
}

/// Root mean square of what a fit leaves of one row of each run that has it, relative to the run's energy.
double left_over(const EnergyProblem& problem, const EnergyFit& fit, Eigen::Index row) {
  double square = 0, count = 0;
  for (std::size_t r = 0; r < problem.runs.size(); ++r) {
    const Eigen::VectorXd gap_J = row_gaps_J(problem, fit, r);
    if (row >= gap_J.size()) continue;
    square += std::pow(gap_J[row] / problem.runs[r].measured_J(), 2), count += 1;
  }
  const double freedom = count - static_cast<double>(fit.state.effects.size()) - 1;
  return freedom > 0 ? std::sqrt(square / freedom) : 0.0;
}

void linearize(EnergyProblem& problem, const std::vector<Candidate>& candidates) {
  problem.equations =
      build_energy_equations(problem.runs, problem.robot, problem.nuisances,
                             {.nuisance_fraction = std::vector<double>(problem.nuisances.size(), 0.0)},
                             no_doubts(), candidates, problem.noise);
}

/// The residual of the best explanation is not noise of the readings, but it limits the confidence in the
/// model: the scatter grows until the best explanation is as good as it claims.
void add_model_error(EnergyProblem& problem) {
  for (int round = 0; round < kNoiseRounds; ++round) {
    const Explanation best = explain_energies(problem, every(problem.runs.size())).front();
    if (best.candidates.empty()) return;
    const EnergyFit fit = fit_energies(problem, every(problem.runs.size()), candidates_of(problem, best));
    problem.noise.sum = std::max(problem.noise.sum, left_over(problem, fit, 0));
    problem.noise.difference = std::max(problem.noise.difference, left_over(problem, fit, 1));
    linearize(problem, std::vector<Candidate>(problem.equations.candidates));
  }
}

}  // namespace

std::vector<Candidate> candidates_of(const EnergyProblem& problem, const Explanation& explanation) {
  std::vector<Candidate> candidates;
  for (int c : explanation.candidates)
    candidates.push_back(problem.equations.candidates[static_cast<std::size_t>(c)]);
  return candidates;
}

EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                  const std::set<std::string>& without) {
  EnergyProblem problem{.robot = robot, .runs = std::move(runs), .nuisances = nuisances_of(robot)};
  problem.noise = estimate_energy_noise(problem.runs, robot);
  std::set<std::string> left_out = beyond_energies(problem.runs);
  problem.hidden = left_out;
  left_out.insert(without.begin(), without.end());
  linearize(problem, catalog_candidates(robot, left_out));
  find_visible(problem);
  problem.repeatability = problem.noise;
  add_model_error(problem);
  return problem;
}

std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                          const std::vector<std::size_t>& which) {
  std::vector<Explanation> explanations =
      search_explanations(without_calibration(problem.equations, which), problem.equations,
                          {.most_effects = problem.visible.empty() ? 0 : kMostEffectsOfEnergies,
                           .allowed = problem.visible,
                           .least_amplitude = least_amplitudes(problem)});
  std::erase_if(explanations, [](const Explanation& e) { return !e.material; });
  return explanations;
}

EnergyFit fit_energies(const EnergyProblem& problem, const std::vector<std::size_t>& which,
                       const std::vector<Candidate>& effects) {
  EnergyFit fit{.state = {.nuisance_fraction = std::vector<double>(problem.nuisances.size(), 0.0)},
                .doubts = no_doubts(),
                .sd = std::vector<Eigen::VectorXd>(effects.size())};
  for (const Candidate& candidate : effects)
    fit.state.effects.push_back({candidate, std::vector<double>(candidate.amplitude.size(), 0.0)});
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Equations equations = build_energy_equations(problem.runs, problem.robot, problem.nuisances,
                                                       fit.state, fit.doubts, effects, problem.noise);
    const std::vector<int> amplitudes = equations.columns_of(Column::Kind::amplitude);
    Eigen::MatrixXd covariance;
    const Eigen::VectorXd parameters = fit_parameters(equations, which, amplitudes, 1.0, &covariance);
    const auto nuisances = static_cast<Eigen::Index>(problem.nuisances.size());
    for (Eigen::Index k = 0; k < nuisances; ++k)
      fit.state.nuisance_fraction[static_cast<std::size_t>(k)] = parameters[k];
    fit.doubts = parameters.segment(nuisances, fit.doubts.size());
    Eigen::Index row = nuisances + fit.doubts.size();
    for (std::size_t e = 0; e < effects.size(); ++e) {
      std::vector<double>& amplitude = fit.state.effects[e].amplitude;
      fit.sd[e].resize(static_cast<Eigen::Index>(amplitude.size()));
      for (std::size_t a = 0; a < amplitude.size(); ++a, ++row) {
        amplitude[a] = effects[e].nonnegative ? std::max(0.0, parameters[row]) : parameters[row];
        fit.sd[e][static_cast<Eigen::Index>(a)] = std::sqrt(covariance(row, row));
      }
    }
  }
  return fit;
}

Eigen::VectorXd row_gaps_J(const EnergyProblem& problem, const EnergyFit& fit, std::size_t r) {
  const ModelPoint point = model_point(problem.robot, problem.nuisances, fit.state);
  const EnergyRun& run = problem.runs[r];
  const auto rows = [&](const DrivenMotion& motion) { return energy_rows(run, joules_of(motion, point)); };
  Eigen::VectorXd predicted_J = rows(run.motion);
  for (std::size_t k = 0; k < kMotionDoubts.size(); ++k)
    predicted_J +=
        0.5 * fit.doubts[static_cast<Eigen::Index>(k)] * (rows(run.doubted[k][1]) - rows(run.doubted[k][0]));
  return predicted_J - measured_rows(run);
}

Eigen::VectorXd energy_gaps_J(const EnergyProblem& problem, const EnergyFit& fit,
                              const std::vector<std::size_t>& which) {
  Eigen::VectorXd gap_J(static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i)
    gap_J[static_cast<Eigen::Index>(i)] = row_gaps_J(problem, fit, which[i])[0];
  return gap_J;
}

}  // namespace joulepath
