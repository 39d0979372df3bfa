#pragma once

#include <set>
#include <vector>

#include "diagnosis/energies_only/energy_equations.hpp"
#include "diagnosis/evidence/attribution.hpp"

namespace joulepath {

/// Everything that may be asked of runs without a log, linearized about the robot file.
struct EnergyProblem {
  const Robot& robot;
  std::vector<EnergyRun> runs{};
  std::vector<Nuisance> nuisances{};
  EnergyNoise repeatability{};     ///< of the readings
  EnergyNoise noise{};             ///< with what the best explanation leaves
  Equations equations{};           ///< whole catalog, less what energies cannot show at all
  std::vector<int> visible{};      ///< candidates that these runs could show
  std::set<std::string> hidden{};  ///< labels of the others
};

[[nodiscard]] EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                                const std::set<std::string>& without);

/// Weighs sets of at most two effects on some of the runs; best first, only material ones.
[[nodiscard]] std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                                        const std::vector<std::size_t>& which);

/// A set of effects fitted to energies by Gauss-Newton on full predictions.
struct EnergyFit {
  ModelState state{};
  Eigen::VectorXd doubts{};           ///< of the motion, in sigmas
  std::vector<Eigen::VectorXd> sd{};  ///< per effect: of its amplitudes
};
[[nodiscard]] EnergyFit fit_energies(const EnergyProblem& problem, const std::vector<std::size_t>& which,
                                     const std::vector<Candidate>& effects);

[[nodiscard]] std::vector<Candidate> candidates_of(const EnergyProblem& problem,
                                                   const Explanation& explanation);

/// Predicted less measured rows (J) of a run: sum of the wheels, right less left; or the battery.
[[nodiscard]] Eigen::VectorXd row_gaps_J(const EnergyProblem& problem, const EnergyFit& fit, std::size_t run);

/// Predicted less measured energy (J) of some runs.
[[nodiscard]] Eigen::VectorXd energy_gaps_J(const EnergyProblem& problem, const EnergyFit& fit,
                                            const std::vector<std::size_t>& which);

}  // namespace joulepath
