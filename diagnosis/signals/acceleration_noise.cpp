#include "diagnosis/signals/acceleration_noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0501-motion.md
namespace joulepath {
namespace {

constexpr double kMedianOfChiSquare = 0.454936;  ///< with one degree of freedom

double noise_variance(const Eigen::VectorXd& mode, double third_difference_gain) {
  std::vector<double> squares;
  for (Eigen::Index j = 3; j < mode.size(); ++j) {
    const double difference = mode[j] - 3 * mode[j - 1] + 3 * mode[j - 2] - mode[j - 3];
    squares.push_back(difference * difference);
  }
  if (squares.empty()) return 0.0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / (kMedianOfChiSquare * third_difference_gain);
}

Eigen::VectorXd above_noise(const Eigen::VectorXd& mode, double variance, Eigen::Index half_width,
                            double over_noise) {
  const double least = over_noise * variance;
  Eigen::VectorXd kept = mode;
  for (Eigen::Index j = 0; j < mode.size(); ++j) {
    const Eigen::Index first = std::max<Eigen::Index>(0, j - half_width),
                       count = std::min(mode.size(), j + half_width + 1) - first;
    if (mode.segment(first, count).squaredNorm() < least * static_cast<double>(count)) kept[j] = 0;
  }
  return kept;
}

Eigen::Index half_window(double period_s) { return std::lround(kAccelerationWindow_s / period_s); }

/// Keeps what stands out of its noise in both modes.
NoisyModes keep_above_noise(Sided<Eigen::VectorXd>& wheels, double third_difference_gain,
                            Eigen::Index half_width, double over_noise) {
  NoisyModes squares;
  const auto kept = [&](const Eigen::VectorXd& mode, NoisySquares& of_mode) {
    const double variance = noise_variance(mode, third_difference_gain);
    Eigen::VectorXd result = above_noise(mode, variance, half_width, over_noise);
    of_mode = {.all = result.squaredNorm(),
               .noise = variance * static_cast<double>((result.array() != 0).count())};
    return result;
  };
  const Eigen::VectorXd driving = kept(0.5 * (wheels.left + wheels.right), squares.driving),
                        turning = kept(0.5 * (wheels.right - wheels.left), squares.turning);
  wheels = {driving - turning, driving + turning};
  return squares;
}

}  // namespace

NoisyModes remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2,
                                     double third_difference_gain, double period_s) {
  if (period_s > kLongestNoisePeriod_s) return {};
  return keep_above_noise(acceleration_rad_s2, third_difference_gain, half_window(period_s),
                          kAccelerationOverNoise);
}

void remove_jerk_noise(Sided<Eigen::VectorXd>& jerk_rad_s3, double third_difference_gain) {
  keep_above_noise(jerk_rad_s3, third_difference_gain, 1, kJerkOverNoise);
}

std::vector<bool> beyond_noise(const Eigen::VectorXd& signal, double third_difference_gain, double period_s) {
  std::vector<bool> beyond(static_cast<std::size_t>(signal.size()), true);
  if (period_s > kLongestNoisePeriod_s) return beyond;
  const Eigen::VectorXd kept = above_noise(signal, noise_variance(signal, third_difference_gain),
                                           half_window(period_s), kAccelerationOverNoise);
  for (std::size_t j = 0; j < beyond.size(); ++j) beyond[j] = kept[static_cast<Eigen::Index>(j)] != 0;
  return beyond;
}

}  // namespace joulepath
