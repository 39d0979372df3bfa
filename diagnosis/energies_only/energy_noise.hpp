#pragma once

#include <vector>

#include "diagnosis/energies_only/energy_run.hpp"

namespace joulepath {

/// Random scatter of energies between runs, relative to the energy of a run.
struct EnergyNoise {
  double sum{};         ///< of both wheels, or of the battery
  double difference{};  ///< right minus left
};

/// Scatter about a smooth function of payload, acceleration and kind of path, corrected for degrees of
/// freedom; a typical value where there are too few runs.
[[nodiscard]] EnergyNoise estimate_energy_noise(const std::vector<EnergyRun>& runs, const Robot& robot);

/// Expected |gap| (percent of the measured energy) of a correct model.
[[nodiscard]] double noise_floor_percent(const EnergyNoise& noise);

/// Relative error of the model's energy for each run of `judged`, as a smooth function of payload,
/// acceleration and kind of path that is fitted to the runs of `fitted`: an error that any model could
/// correct.
[[nodiscard]] Eigen::VectorXd smooth_error(const std::vector<EnergyRun>& runs,
                                           const std::vector<std::size_t>& fitted,
                                           const std::vector<std::size_t>& judged, const Robot& robot);

}  // namespace joulepath
