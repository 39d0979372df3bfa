#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/signals/acceleration_noise.hpp"
#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// Noise of a usable log's accelerations, and the width of the kernel under which it was seen. What the third
/// differences of smoothed accelerations have is noise or motion; noise is no more than white noise of the
/// samples would leave.
struct SmoothedNoise {
  NoisyModes accelerations{};
  double kernel_sigma_s{};
};
[[nodiscard]] SmoothedNoise smoothed_noise(const Run& run, const Robot& robot, const SignalOptions& options);

/// Widens the kernel of these runs to what the noise of their encoders asks for, and the distance of the rows
/// with it. Such noise passes for motion that takes no torque: a fit finds that much less inertia.
void widen_kernel(const Dataset& dataset, const std::vector<std::size_t>& runs, SignalOptions& options);

}  // namespace joulepath
