#include "diagnosis/numerics/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath {

SmoothingKernel gaussian_kernel(double sigma_s, double period_s) {
  const int half = std::max(1, static_cast<int>(std::ceil(3.5 * sigma_s / period_s)));
  SmoothingKernel kernel;
  double sum = 0, first_moment = 0;
  for (int k = -half; k <= half; ++k) {
    const double t = k * period_s;
    const double w = std::exp(-t * t / (2 * sigma_s * sigma_s));
    kernel.weight.push_back(w);
    kernel.slope_weight.push_back(t * w);
    sum += w;
    first_moment += t * t * w;
  }
  for (double& w : kernel.weight) w /= sum;
  for (double& w : kernel.slope_weight) w /= first_moment;
  const double variance = first_moment / sum;
  double of_parabola = 0;
  for (int k = -half; k <= half; ++k) {
    const double t = k * period_s;
    kernel.curvature_weight.push_back((t * t - variance) * kernel.weight[static_cast<std::size_t>(k + half)]);
    of_parabola += 0.5 * t * t * kernel.curvature_weight.back();
  }
  for (double& w : kernel.curvature_weight) w /= of_parabola;
  return kernel;
}

double convolve_at(const std::vector<double>& values, const std::vector<double>& weights,
                   std::size_t center) {
  const long half = static_cast<long>(weights.size() / 2), last = static_cast<long>(values.size()) - 1;
  double sum = 0;
  for (long k = -half; k <= half; ++k)
    sum += weights[static_cast<std::size_t>(k + half)] *
           values[static_cast<std::size_t>(std::clamp(static_cast<long>(center) + k, 0L, last))];
  return sum;
}

std::vector<double> interpolate(const std::vector<double>& time_s, const std::vector<double>& values,
                                const std::vector<double>& at_s) {
  std::vector<double> result(at_s.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < at_s.size(); ++i) {
    while (k + 2 < time_s.size() && time_s[k + 1] <= at_s[i]) ++k;
    while (k > 0 && time_s[k] > at_s[i]) --k;
    if (time_s.size() < 2) {
      result[i] = values.empty() ? 0.0 : values.front();
      continue;
    }
    const double u = std::clamp((at_s[i] - time_s[k]) / (time_s[k + 1] - time_s[k]), 0.0, 1.0);
    result[i] = (1 - u) * values[k] + u * values[k + 1];
  }
  return result;
}

std::vector<double> unwrap_angle(std::vector<double> angle_rad) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double shift = 0;
  for (std::size_t i = 1; i < angle_rad.size(); ++i) {
    const double step = angle_rad[i] + shift - angle_rad[i - 1];
    shift -= kTurn * std::round(step / kTurn);
    angle_rad[i] += shift;
  }
  return angle_rad;
}

}  // namespace joulepath
