#pragma once

#include <vector>

#include "diagnosis/evidence/whitening.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {

/// Localizes the power gap: per axis (phase, wheel, speed, payload, floor, heading, direction, time of day,
/// run, channel) the share of the summed absolute gap, with the expected share of noise subtracted and an
/// interval over runs. The shares over one axis add up to 1.
[[nodiscard]] std::vector<WhereCell> localize_gap(const std::vector<RunSignals>& signals,
                                                  const ModelPoint& nominal, const NoiseModel& noise,
                                                  std::size_t bootstrap);

}  // namespace joulepath
