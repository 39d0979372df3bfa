#pragma once

#include <vector>

namespace joulepath::calibration {

/// A symmetric kernel that smooths samples and an antisymmetric kernel for the derivative of the smoothed
/// samples. Both act on all channels, so a linear relation between channels and derivatives is preserved and
/// smoothing causes no bias.
struct SplineKernel {
  std::vector<double> value{};       ///< odd count, sum 1
  std::vector<double> derivative{};  ///< odd count, eight entries longer
  double value_gain{};               ///< variance of smoothed white noise of variance 1
  double derivative_gain{};  ///< variance of the derivative of smoothed white noise of variance 1 (1/s^2)

  std::size_t reach() const { return derivative.size() / 2; }  ///< samples needed on each side
};

/// A cubic B-spline of standard deviation max(`deviation_s`, 1.5 samples); the derivative uses central
/// differences of eighth order.
[[nodiscard]] SplineKernel make_spline_kernel(double sample_period_s, double deviation_s);

/// Sum of the weights times the samples around `center`.
[[nodiscard]] double weighted(const std::vector<double>& weights, const std::vector<double>& samples,
                              std::size_t center);

/// Standard deviation of the white noise on a smooth signal, from the median absolute deviation of its fourth
/// differences (robust against kinks and steps).
[[nodiscard]] double white_noise_deviation(const std::vector<double>& samples);

}  // namespace joulepath::calibration
