#pragma once

#include <vector>

namespace joulepath {

/// A Gaussian kernel on a uniform grid and its derivatives, discrete and normalized: smoothing preserves
/// constants, and the derivatives give the slope of a straight line and the curvature of a parabola exactly.
struct SmoothingKernel {
  std::vector<double> weight{};
  std::vector<double> slope_weight{};      ///< 1/s
  std::vector<double> curvature_weight{};  ///< 1/s^2
  std::size_t half_width() const { return weight.size() / 2; }
};

SmoothingKernel gaussian_kernel(double sigma_s, double period_s);

/// sum_k weights[k] values[center - half + k]; the first and last values continue beyond the ends.
double convolve_at(const std::vector<double>& values, const std::vector<double>& weights, std::size_t center);

/// Values at `at_s`: linear interpolation, constant beyond the ends.
std::vector<double> interpolate(const std::vector<double>& time_s, const std::vector<double>& values,
                                const std::vector<double>& at_s);

/// Adds multiples of 2 pi so that consecutive angles differ by less than pi.
std::vector<double> unwrap_angle(std::vector<double> angle_rad);

}  // namespace joulepath
