#pragma once

#include <vector>

#include "diagnosis/energies_only/energy_run.hpp"

namespace joulepath {

/// How much energies scatter from run to run for no reason that the runs tell, relative to a run's energy.
struct EnergyNoise {
  double sum{};         ///< of both wheels, or of the battery
  double difference{};  ///< right less left
};

/// Scatter about a smooth function of payload, acceleration and kind of path, degrees of freedom taken off;
/// a usual value where there are too few runs to tell.
[[nodiscard]] EnergyNoise estimate_energy_noise(const std::vector<EnergyRun>& runs, const Robot& robot);

/// Expected |gap| (percent of the measured energy) of a model that is right.
[[nodiscard]] double noise_floor_percent(const EnergyNoise& noise);

/// Relative error of the model's energy that a smooth function of payload, acceleration and kind of path
/// expects for each run of `judged`, fitted on those of `fitted`: what any model could correct.
[[nodiscard]] Eigen::VectorXd smooth_error(const std::vector<EnergyRun>& runs,
                                           const std::vector<std::size_t>& fitted,
                                           const std::vector<std::size_t>& judged, const Robot& robot);

}  // namespace joulepath
