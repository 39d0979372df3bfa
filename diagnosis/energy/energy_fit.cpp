#include "diagnosis/energy/energy_fit.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/indices.hpp"

namespace joulepath {
namespace {

constexpr int kIterations = 3;
constexpr int kMostEffects = 2;         ///< a sum and a difference per run do not carry more
constexpr double kMaterial = 0.01;      ///< of the energy
constexpr double kVisibleSigmas = 2.0;  ///< that a large effect must move the data beyond calibration

/// Where on the floor, when in the day and at which sample something happened, energies do not say.
std::set<std::string> beyond_energies(const std::vector<EnergyRun>& runs) {
  std::set<std::string> names{"floor_slope", "floor_patch", "time_misalignment"};
  const bool dated =
      std::ranges::all_of(runs, [](const EnergyRun& run) { return run.motion.signals.time_of_day_known; });
  if (!dated) names.insert("winding_heating");
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

/// Amplitude of each candidate that changes the runs' energy by as much as matters.
std::vector<double> least_amplitudes(const EnergyProblem& problem) {
  const Equations& equations = problem.equations;
  const LinearProblem all = sum_runs(equations.runs, every(problem.runs.size()), equations.prior_sd);
  std::vector<double> least;
  for (std::size_t c = 0; c < equations.candidates.size(); ++c) {
    const int k = equations.columns_of_candidate(static_cast<int>(c), false).front();
    const double per_amplitude =
        problem.noise.sum * std::sqrt(all.gram(k, k) / static_cast<double>(problem.runs.size()));
    least.push_back(per_amplitude > 0 ? kMaterial / per_amplitude : 1e300);
  }
  return least;
}

}  // namespace

EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                  const std::set<std::string>& without) {
  EnergyProblem problem{.robot = robot, .runs = std::move(runs), .nuisances = nuisances_of(robot)};
  problem.noise = estimate_energy_noise(problem.runs, robot);
  std::set<std::string> left_out = beyond_energies(problem.runs);
  problem.hidden = left_out;
  left_out.insert(without.begin(), without.end());
  problem.equations =
      build_energy_equations(problem.runs, robot, problem.nuisances,
                             {.nuisance_fraction = std::vector<double>(problem.nuisances.size(), 0.0)},
                             no_doubts(), catalog_candidates(robot, left_out), problem.noise);
  find_visible(problem);
  return problem;
}

std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                          const std::vector<std::size_t>& which) {
  std::vector<Explanation> explanations =
      search_explanations(without_calibration(problem.equations, which), problem.equations,
                          {.most_effects = problem.visible.empty() ? 0 : kMostEffects,
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

Eigen::VectorXd energy_gaps_J(const EnergyProblem& problem, const EnergyFit& fit,
                              const std::vector<std::size_t>& which) {
  const ModelPoint point = model_point(problem.robot, problem.nuisances, fit.state);
  Eigen::VectorXd gap_J(static_cast<Eigen::Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) {
    const EnergyRun& run = problem.runs[which[i]];
    double predicted_J = run.of(joules_of(run.motion, point));
    for (std::size_t k = 0; k < kMotionDoubts.size(); ++k)
      predicted_J +=
          0.5 * fit.doubts[static_cast<Eigen::Index>(k)] *
          (run.of(joules_of(run.doubted[k][1], point)) - run.of(joules_of(run.doubted[k][0], point)));
    gap_J[static_cast<Eigen::Index>(i)] = predicted_J - run.measured_J();
  }
  return gap_J;
}

}  // namespace joulepath
