#pragma once

#include <vector>

#include "diagnosis/energies_only/energy_run.hpp"
#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// Compared quantities of a run: sum of the wheels, right minus left; or the battery's energy alone (J).
[[nodiscard]] Eigen::VectorXd energy_rows(const EnergyRun& run, const RunJoules& joules);
[[nodiscard]] Eigen::VectorXd measured_rows(const EnergyRun& run);

/// Unexplained scatter of energies from run to run, relative to a run's energy.
struct EnergyNoise {
  double sum{};         ///< of both wheels, or of the battery
  double difference{};  ///< right minus left
};

/// Scatter about a smooth function of payload, acceleration and kind of path, corrected for degrees of
/// freedom; a typical value where there are too few runs.
[[nodiscard]] EnergyNoise estimate_energy_noise(const std::vector<EnergyRun>& runs, const Robot& robot);

/// Expected |gap| (percent of the measured energy) of a model that is right.
[[nodiscard]] double noise_floor_percent(const EnergyNoise& noise);

/// Relative error of the model's energy that a smooth function of payload, acceleration and kind of path
/// expects for each run of `judged`, fitted on those of `fitted`: what any model could correct.
[[nodiscard]] Eigen::VectorXd smooth_error(const std::vector<EnergyRun>& runs,
                                           const std::vector<std::size_t>& fitted,
                                           const std::vector<std::size_t>& judged, const Robot& robot);

/// The linear problem about a state: of each run two rows (sum of the wheels, right minus left; or the
/// battery alone) over their scatter. `doubts` are the values of kMotionDoubts that the state assumes, in
/// sigmas; their columns come right after the nuisances'.
[[nodiscard]] Equations build_energy_equations(const std::vector<EnergyRun>& runs, const Robot& robot,
                                               const std::vector<Nuisance>& nuisances,
                                               const ModelState& state, const Eigen::VectorXd& doubts,
                                               const std::vector<Candidate>& candidates,
                                               const EnergyNoise& noise);

}  // namespace joulepath
