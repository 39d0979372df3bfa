#pragma once

#include <array>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/channels.hpp"

namespace joulepath {

/// The least noise (1-sigma) that a channel is given, whatever its residual says: a share of what the
/// channel reads, as no instrument resolves more. Keeps logs without any noise, such as a simulator's,
/// from being believed to the last digit.
[[nodiscard]] std::array<double, kChannelCount> resolution_floor(const std::vector<RunSignals>& signals);

}  // namespace joulepath
