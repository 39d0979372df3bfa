#include "diagnosis/prediction/body_swing.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/kinematics.hpp"
// Design: docs/decisions/0501-motion.md
namespace joulepath {
namespace {

/// Kernels of the swing over that of the rows. Chosen (0501).
constexpr std::array kSwingKernels{1.0, 1.5, 2.0, 2.5, 3.0, 4.0};

Lagged none(Eigen::Index n) { return {Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)}; }

/// Variance of the second derivative of an acceleration under a kernel so many times as wide as that of the
/// rows over that of the acceleration, of white noise of the speed, times the fourth power of the rows'
/// kernel.
double noise_gain(double widening) { return 3.75 * std::pow(1 + widening * widening, -3.5); }

Lagged swing_under(const SmoothingKernel& kernel, const Eigen::VectorXd& acceleration) {
  const std::vector<double> values(acceleration.begin(), acceleration.end());
  const auto convolved = [&](const std::vector<double>& weights) -> Eigen::VectorXd {
    return Eigen::VectorXd::NullaryExpr(acceleration.size(), [&](Eigen::Index j) {
      return convolve_at(values, weights, static_cast<std::size_t>(j));
    });
  };
  return {.value = convolved(kernel.slope_weight), .rate = convolved(kernel.curvature_weight)};
}

/// First and second derivative of a mode of the wheels' acceleration, under the narrowest kernel that leaves
/// next to no noise in the second; or nothing.
Lagged swing_of(const Eigen::VectorXd& acceleration, const NoisySquares& noise, const RunSignals& signals) {
  const double variance_sum =
      noise.noise_share() * acceleration.squaredNorm() / std::pow(signals.kernel_sigma_s, 4);
  for (const double widening : kSwingKernels) {
    const SmoothingKernel kernel = gaussian_kernel(widening * signals.kernel_sigma_s, signals.period_s);
    Lagged swing = swing_under(kernel, acceleration);
    if (noise_gain(widening) * variance_sum <= kMostSwingNoise * swing.rate.squaredNorm()) return swing;
  }
  return none(acceleration.size());
}

}  // namespace

BodyLag swing_along(const RunSignals& signals, const Geometry& geometry) {
  const Twist<Eigen::VectorXd> rolled = body_twist(geometry, signals.wheel_acceleration_rad_s2);
  return {.along = swing_of(rolled.speed_m_s, signals.acceleration_noise.driving, signals),
          .turn = none(signals.size())};
}

BodyLag swing_in_yaw(const RunSignals& signals, const Geometry& geometry) {
  const Twist<Eigen::VectorXd> rolled = body_twist(geometry, signals.wheel_acceleration_rad_s2);
  return {.along = none(signals.size()),
          .turn = swing_of(rolled.yaw_rate_rad_s, signals.acceleration_noise.turning, signals)};
}

}  // namespace joulepath
