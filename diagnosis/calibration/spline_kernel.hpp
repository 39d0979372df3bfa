#pragma once

#include <vector>

namespace joulepath::calibration {

/// A pair of symmetric and antisymmetric weights: the first smooths samples, the second gives the derivative
/// of what the first gives. A linear relation between channels and derivatives survives: the same kernel acts
/// on all of them, so that smoothing brings no bias.
struct SplineKernel {
  std::vector<double> value{};       ///< odd count, adds up to 1
  std::vector<double> derivative{};  ///< odd count, longer by eight
  double value_gain{};               ///< variance of a smoothed white noise of variance 1
  double derivative_gain{};          ///< variance of its derivative (1/s^2)

  std::size_t reach() const { return derivative.size() / 2; }  ///< samples needed on each side
};

/// A cubic B-spline of standard deviation max(`deviation_s`, 1.5 samples); the derivative uses central
/// differences of eighth order.
[[nodiscard]] SplineKernel make_spline_kernel(double sample_period_s, double deviation_s);

/// Sum of weights times the samples around `center`.
[[nodiscard]] double weighted(const std::vector<double>& weights, const std::vector<double>& samples,
                              std::size_t center);

/// Standard deviation of the white noise on a smooth signal, from its fourth differences (median absolute
/// deviation, so that kinks and steps do not count).
[[nodiscard]] double white_noise_deviation(const std::vector<double>& samples);

}  // namespace joulepath::calibration
