#pragma once

#include <set>
#include <vector>

#include "diagnosis/energies_only/energy_noise.hpp"
#include "diagnosis/evidence/attribution.hpp"

namespace joulepath {

/// Runs without a log as the linear problem that logs are, linearized about the robot file: of each run two
/// rows (sum of the wheels, right less left; or the battery alone) over their scatter.
struct EnergyProblem {
  const Robot& robot;
  std::vector<EnergyRun> runs{};
  std::vector<Nuisance> nuisances{};
  std::vector<Eigen::MatrixXd> rows_J{};  ///< of each run: slope of each column, then measured less predicted
  EnergyNoise repeatability{};            ///< of the readings
  EnergyNoise noise{};                    ///< with what the best candidates leave
  Equations equations{};           ///< the rows over `noise`; the catalog without what energies cannot show
  std::vector<int> visible{};      ///< candidates that these runs could show
  std::set<std::string> hidden{};  ///< labels of the others
};

[[nodiscard]] EnergyProblem pose_energy_problem(const Robot& robot, std::vector<EnergyRun> runs,
                                                const std::set<std::string>& without);

/// Weighs sets of at most two effects on some of the runs; best first, only material ones.
[[nodiscard]] std::vector<Explanation> explain_energies(const EnergyProblem& problem,
                                                        const std::vector<std::size_t>& which);

/// Runs (indices into EnergyProblem::runs) that fit, and those that only judge.
struct EnergyFold {
  std::vector<std::size_t> fitted{};
  std::vector<std::size_t> judged{};
};

/// One fold where the dataset says `use: validation`; else four, each run judging once, spread over kinds of
/// path, payloads and accelerations.
[[nodiscard]] std::vector<EnergyFold> energy_folds(const Dataset& dataset,
                                                   const std::vector<EnergyRun>& runs);

/// Predicted less measured energies (J) of judged runs, run by run, under models that they took no part in.
struct HeldOutEnergies {
  std::vector<std::size_t> runs{};
  std::vector<double> measured_J{};
  std::vector<double> before_J{};  ///< under the robot file
  std::vector<double>
      after_J{};  ///< with the candidates and the calibration that the fold's other runs choose
  std::vector<double> smooth_J{};  ///< under any smooth function of the runs' circumstances
};
[[nodiscard]] HeldOutEnergies judge_held_out(const EnergyProblem& problem,
                                             const std::vector<EnergyFold>& folds);

}  // namespace joulepath
