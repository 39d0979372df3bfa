#include "diagnosis/signals/kernel_width.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0501-motion.md
namespace joulepath {
namespace {

/// Of the mean square of an acceleration where it stands out of its noise, from which on the kernel is
/// widened. Derived: mass and motor constants are uncertain by 1 %. Chosen: wider kernels cost power.
constexpr double kNotableAccelerationNoise = 0.006;
/// The same, as a wider kernel leaves it. Derived: a third of the 1 %.
constexpr double kMostAccelerationNoise = 0.003;
/// Of the kernel. Chosen: a usual stop at 0.4 m/s^2 is still seen.
constexpr double kMostWidening = 2.5;

}  // namespace

void widen_kernel(const Dataset& dataset, const std::vector<std::size_t>& runs, SignalOptions& options) {
  NoisySquares driving, turning;
  double widest_s = 0;
  for (std::size_t r : runs) {
    const SmoothedNoise noise = smoothed_noise(dataset.runs[r], dataset.robot, options);
    driving += noise.accelerations.driving;
    turning += noise.accelerations.turning;
    widest_s = std::max(widest_s, noise.kernel_sigma_s);
  }
  const double share = std::max(driving.noise_share(), turning.noise_share());
  if (share <= kNotableAccelerationNoise) return;
  const double widening = std::min(kMostWidening, std::cbrt(share / kMostAccelerationNoise));
  options.kernel_sigma_s = widening * widest_s;
  options.period_s = std::min(widening * options.period_s, kCoarsestPeriod_s);
}

}  // namespace joulepath
