#pragma once

#include "diagnosis/energies_only/energy_noise.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Where the energy gap of runs without a log lies: by kind of path, payload, acceleration, wheel and run.
[[nodiscard]] std::vector<WhereCell> localize_energy_gap(const std::vector<EnergyRun>& runs,
                                                         const Robot& robot, const EnergyNoise& noise,
                                                         std::size_t bootstrap);

}  // namespace joulepath
