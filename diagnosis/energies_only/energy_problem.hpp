#pragma once

#include <set>
#include <vector>

#include "diagnosis/energies_only/energy_noise.hpp"
#include "diagnosis/evidence/attribution.hpp"

namespace joulepath {

/// Runs without a log as a linear problem of the same form as for logs, linearized about the robot file. Each
/// run has two rows (sum of the wheels and right minus left, or the battery only), divided by their scatter.
struct EnergyProblem {
  const Robot& robot;
  std::vector<EnergyRun> runs{};
  std::vector<Nuisance> nuisances{};
  std::vector<Eigen::MatrixXd> rows_J{};  ///< per run: slope of each column, then measured minus predicted
  EnergyNoise repeatability{};            ///< of the readings
  EnergyNoise noise{};                    ///< including the residual of the best candidates
  Equations equations{};           ///< rows divided by `noise`, without the effects that energies cannot show
  std::vector<int> visible{};      ///< candidates that these runs could show
  std::set<std::string> hidden{};  ///< labels of the others
};

[[nodiscard]] EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                                const std::set<std::string>& without);

/// Explanations of at most two effects, fitted to some of the runs; only material ones, best first.
[[nodiscard]] std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                                        const std::vector<std::size_t>& which);

/// Runs (indices into EnergyProblem::runs) used for the fit, and held-out runs.
struct EnergyFold {
  std::vector<std::size_t> fitted{};
  std::vector<std::size_t> judged{};
};

/// One fold where the dataset has `use: validation`; else four folds that hold out each run once, balanced
/// over kinds of path, payloads and accelerations.
[[nodiscard]] std::vector<EnergyFold> energy_folds(const Dataset& dataset,
                                                   const std::vector<EnergyRun>& runs);

/// Predicted minus measured energies (J) of the held-out runs.
struct HeldOutEnergies {
  std::vector<std::size_t> runs{};
  std::vector<double> measured_J{};
  std::vector<double> before_J{};  ///< under the robot file
  std::vector<double> after_J{};  ///< with the candidates and the calibration chosen by the fold's other runs
  std::vector<double> smooth_J{};  ///< with the smooth function of the runs' variables
};
[[nodiscard]] HeldOutEnergies judge_held_out(const EnergyProblem& problem,
                                             const std::vector<EnergyFold>& folds);

}  // namespace joulepath
