#include "model/local_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "model/median.hpp"

namespace joulepath {

LocalFit fit_locally(const std::vector<double>& time_s, const std::vector<double>& values, double reach_s) {
  const std::size_t size = time_s.size();
  LocalFit fit{values, std::vector<double>(size, 0.0)};
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < size; ++i) {
    while (time_s[i] - time_s[first] > reach_s) ++first;
    last = std::max(last, i);
    while (last + 1 < size && time_s[last + 1] - time_s[i] <= reach_s) ++last;
    const std::size_t from = std::min(first, i > 0 ? i - 1 : 0);
    const std::size_t to = std::max(last, std::min(i + 1, size - 1));
    if (to <= from) continue;
    const Eigen::Index terms = to - from >= 2 ? 3 : 2;
    const double scale_s = std::max(time_s[to] - time_s[i], time_s[i] - time_s[from]);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity();
    normal.topLeftCorner(terms, terms).setZero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t k = from; k <= to; ++k) {
      const double t = (time_s[k] - time_s[i]) / scale_s;
      const Eigen::Vector3d basis(1.0, t, terms == 3 ? t * t : 0.0);
      normal += basis * basis.transpose();
      right += values[k] * basis;
    }
    const Eigen::Vector3d coefficients = normal.ldlt().solve(right);
    fit.value[i] = coefficients[0];
    fit.slope[i] = coefficients[1] / scale_s;
  }
  return fit;
}

namespace {

/// Where lines between readings bend, at even distances; empty for values that are no such lines.
std::vector<double> readings_on_lines(const std::vector<double>& values, double smallest_bend) {
  constexpr std::size_t kLeastReadings = 20;
  std::vector<double> readings;
  std::vector<std::size_t> steps;
  std::size_t last = 0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    if (std::abs(values[i - 1] - 2 * values[i] + values[i + 1]) <= smallest_bend) continue;
    if (last > 0) steps.push_back(i - last);
    readings.push_back(values[i]);
    last = i;
  }
  if (readings.size() < kLeastReadings) return {};
  const std::size_t step = upper_median(steps);
  const auto even =
      std::count_if(steps.begin(), steps.end(), [&](std::size_t s) { return s == step || s == step + 1; });
  return 2 * even > static_cast<std::ptrdiff_t>(steps.size()) ? readings : std::vector<double>();
}

/// Whether the second differences are those of noise, of which each has a correlation of -2/3 with the next.
bool is_noisy(const std::vector<double>& values) {
  double product = 0, square = 0, before = 0;
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double bend = values[i - 1] - 2 * values[i] + values[i + 1];
    product += bend * before, square += bend * bend;
    before = bend;
  }
  return product < -square / 3;
}

}  // namespace

double noise_of(const std::vector<double>& values) {
  if (values.size() < 5) return 0.0;
  std::vector<double> size;
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    size.push_back(std::abs(values[i - 1] - 2 * values[i] + values[i + 1]));
  // Second differences of white noise have 6 times its variance.
  return upper_median(std::move(size)) / 0.6745 / std::sqrt(6.0);
}

double noise_of_readings(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double rounding = 1e-9 * (*most - *least);
  if (const double noise = noise_of(values); noise > rounding) return noise;
  const std::vector<double> readings = readings_on_lines(values, rounding);
  return is_noisy(readings) ? noise_of(readings) : 0.0;
}

}  // namespace joulepath
