#include "diagnosis/calibration/spline_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/assert.hpp"
#include "model/median.hpp"

namespace joulepath::calibration {
namespace {

/// Cubic B-spline with support (-2, 2).
double cubic_b_spline(double x) {
  x = std::abs(x);
  if (x >= 2) return 0;
  if (x >= 1) return (2 - x) * (2 - x) * (2 - x) / 6;
  return 2.0 / 3 - x * x + x * x * x / 2;
}

double sum_of_squares(const std::vector<double>& weights) {
  double sum = 0;
  for (double weight : weights) sum += weight * weight;
  return sum;
}

}  // namespace

SplineKernel make_spline_kernel(double sample_period_s, double deviation_s) {
  JOULEPATH_ASSERT(sample_period_s > 0, "a sample period is positive");
  // A B-spline of knot distance h has the variance h^2/3.
  const double knot = std::sqrt(3.0) * std::max(deviation_s / sample_period_s, 1.5);
  const int reach = static_cast<int>(std::ceil(2 * knot)) - 1;
  SplineKernel kernel;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    kernel.value.push_back(cubic_b_spline(i / knot)), sum += kernel.value.back();
  for (double& weight : kernel.value) weight /= sum;

  constexpr std::array<double, 4> difference{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  kernel.derivative.assign(kernel.value.size() + 8, 0.0);
  for (std::size_t i = 0; i < kernel.value.size(); ++i)
    for (std::size_t k = 1; k <= 4; ++k) {
      kernel.derivative[i + 4 + k] += difference[k - 1] * kernel.value[i] / sample_period_s;
      kernel.derivative[i + 4 - k] -= difference[k - 1] * kernel.value[i] / sample_period_s;
    }
  kernel.value_gain = sum_of_squares(kernel.value);
  kernel.derivative_gain = sum_of_squares(kernel.derivative);
  return kernel;
}

double weighted(const std::vector<double>& weights, const std::vector<double>& samples, std::size_t center) {
  const std::size_t first = center - weights.size() / 2;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * samples[first + i];
  return sum;
}

double white_noise_deviation(const std::vector<double>& samples) {
  if (samples.size() < 9) return 0;
  std::vector<double> differences;
  for (std::size_t i = 2; i + 2 < samples.size(); ++i)
    differences.push_back(
        std::abs(samples[i - 2] - 4 * samples[i - 1] + 6 * samples[i] - 4 * samples[i + 1] + samples[i + 2]));
  return 1.4826 * upper_median(std::move(differences)) / std::sqrt(70.0);
}

}  // namespace joulepath::calibration
