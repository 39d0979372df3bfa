#pragma once

#include <array>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/channels.hpp"

namespace joulepath {

/// Lower bound of the noise (1-sigma) of each channel: a share of its readings, which models the resolution
/// of instruments. Without it, logs without noise (of a simulator, for example) would count as exact.
[[nodiscard]] std::array<double, kChannelCount> resolution_floor(const std::vector<RunSignals>& signals);

}  // namespace joulepath
