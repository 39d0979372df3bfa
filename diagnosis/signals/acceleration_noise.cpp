#include "diagnosis/signals/acceleration_noise.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0510-accelerations-below-the-noise-count-as-none.md
namespace joulepath {
namespace {

constexpr double kThirdDifferenceGain =
    20.0;  ///< 1 + 9 + 9 + 1: variance of a third difference of white noise
constexpr double kMedianOfChiSquare = 0.454936;  ///< with one degree of freedom

Eigen::VectorXd above_noise(const Eigen::VectorXd& mode, double variance, Eigen::Index half_width) {
  Eigen::VectorXd kept = mode;
  for (Eigen::Index j = 0; j < mode.size(); ++j) {
    const Eigen::Index first = std::max<Eigen::Index>(0, j - half_width),
                       count = std::min(mode.size(), j + half_width + 1) - first;
    const double mean_square = mode.segment(first, count).squaredNorm() / static_cast<double>(count);
    if (mean_square < kAccelerationOverNoise * variance) kept[j] = 0;
  }
  return kept;
}

}  // namespace

double white_noise_variance(const std::vector<double>& samples) {
  std::vector<double> squares;
  for (std::size_t i = 3; i < samples.size(); ++i) {
    const double difference = samples[i] - 3 * samples[i - 1] + 3 * samples[i - 2] - samples[i - 3];
    squares.push_back(difference * difference);
  }
  if (squares.empty()) return 0.0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / (kMedianOfChiSquare * kThirdDifferenceGain);
}

void remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2, double variance,
                               double period_s) {
  const auto half_width = std::max<Eigen::Index>(2, std::lround(kAccelerationWindow_s / period_s));
  const double of_mode = 0.5 * variance;  // of a mean, or of half a difference
  const Eigen::VectorXd driving =
      above_noise(0.5 * (acceleration_rad_s2.left + acceleration_rad_s2.right), of_mode, half_width);
  const Eigen::VectorXd turning =
      above_noise(0.5 * (acceleration_rad_s2.right - acceleration_rad_s2.left), of_mode, half_width);
  acceleration_rad_s2 = {driving - turning, driving + turning};
}

}  // namespace joulepath
