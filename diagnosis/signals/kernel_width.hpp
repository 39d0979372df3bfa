#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// Widens the kernel of these runs to what the noise of their encoders asks for, and the distance of the rows
/// with it. Such noise passes for motion that takes no torque: a fit finds that much less inertia.
void widen_kernel(const Dataset& dataset, const std::vector<std::size_t>& runs, SignalOptions& options);

}  // namespace joulepath
