#include "diagnosis/signals/acceleration_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/thresholds.hpp"
#include "model/median.hpp"
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
  return upper_median(std::move(squares)) / (kMedianOfChiSquare * third_difference_gain);
}

Eigen::Index half_window(double period_s) { return std::lround(kAccelerationWindow_s / period_s); }

/// The samples within half a window of one.
auto window(const Eigen::VectorXd& mode, Eigen::Index at, Eigen::Index half_width) {
  const Eigen::Index first = std::max<Eigen::Index>(0, at - half_width);
  return mode.segment(first, std::min(mode.size(), at + half_width + 1) - first);
}

/// Whether the mean square about each sample is at least so many variances of the noise.
std::vector<bool> standing_out(const Eigen::VectorXd& mode, double variance, Eigen::Index half_width,
                               double over_noise) {
  std::vector<bool> result(static_cast<std::size_t>(mode.size()));
  for (Eigen::Index j = 0; j < mode.size(); ++j) {
    const auto near = window(mode, j, half_width);
    result[static_cast<std::size_t>(j)] =
        near.squaredNorm() >= over_noise * variance * static_cast<double>(near.size());
  }
  return result;
}

/// A mode of the wheels' motion, its noise, and the samples that stand out of it.
struct Mode {
  Eigen::VectorXd value{};
  double variance{};
  std::vector<bool> stands_out{};

  [[nodiscard]] Eigen::VectorXd kept() const {
    Eigen::VectorXd result = value;
    for (Eigen::Index j = 0; j < value.size(); ++j)
      if (!stands_out[static_cast<std::size_t>(j)]) result[j] = 0;
    return result;
  }
  [[nodiscard]] NoisySquares squares() const {
    const Eigen::VectorXd of = kept();
    return {.all = of.squaredNorm(), .noise = variance * static_cast<double>((of.array() != 0).count())};
  }
};

Mode mode_of(const Eigen::VectorXd& value, double third_difference_gain, Eigen::Index half_width,
             double over_noise) {
  const double variance = noise_variance(value, third_difference_gain);
  return {value, variance, standing_out(value, variance, half_width, over_noise)};
}

/// The acceleration where it stands out of its noise; elsewhere the mean of the window, where that stands
/// out. A reading of zero stays: a robot at rest logs zeros.
Eigen::VectorXd without_noise(const Mode& mode, Eigen::Index half_width, double mean_gain) {
  Eigen::VectorXd result = mode.kept();
  const auto whole = static_cast<double>(2 * half_width + 1);
  for (Eigen::Index j = 0; j < result.size(); ++j) {
    if (mode.stands_out[static_cast<std::size_t>(j)] || mode.value[j] == 0) continue;
    const auto near = window(mode.value, j, half_width);
    const double mean = near.mean(), shorter = whole / static_cast<double>(near.size());
    if (mean * mean > kMeanOverNoise * mode.variance * std::min(1.0, mean_gain * shorter * shorter))
      result[j] = mean;
  }
  return result;
}

Eigen::VectorXd driving(const Sided<Eigen::VectorXd>& wheels) { return 0.5 * (wheels.left + wheels.right); }
Eigen::VectorXd turning(const Sided<Eigen::VectorXd>& wheels) { return 0.5 * (wheels.right - wheels.left); }

}  // namespace

NoisyModes remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2,
                                     double third_difference_gain, double period_s, double mean_gain) {
  if (period_s > kLongestNoisePeriod_s) return {};
  const Eigen::Index half_width = half_window(period_s);
  const auto mode = [&](const Eigen::VectorXd& value) {
    return mode_of(value, third_difference_gain, half_width, kAccelerationOverNoise);
  };
  const Mode drive = mode(driving(acceleration_rad_s2)), turn = mode(turning(acceleration_rad_s2));
  const Eigen::VectorXd along = without_noise(drive, half_width, mean_gain),
                        around = without_noise(turn, half_width, mean_gain);
  acceleration_rad_s2 = {along - around, along + around};
  return {drive.squares(), turn.squares()};
}

void remove_jerk_noise(Sided<Eigen::VectorXd>& jerk_rad_s3, double third_difference_gain) {
  const auto kept = [&](const Eigen::VectorXd& value) {
    return mode_of(value, third_difference_gain, 1, kJerkOverNoise).kept();
  };
  const Eigen::VectorXd along = kept(driving(jerk_rad_s3)), around = kept(turning(jerk_rad_s3));
  jerk_rad_s3 = {along - around, along + around};
}

std::vector<bool> beyond_noise(const Eigen::VectorXd& signal, double third_difference_gain, double period_s) {
  std::vector<bool> beyond(static_cast<std::size_t>(signal.size()), true);
  if (period_s > kLongestNoisePeriod_s) return beyond;
  beyond = standing_out(signal, noise_variance(signal, third_difference_gain), half_window(period_s),
                        kAccelerationOverNoise);
  for (std::size_t j = 0; j < beyond.size(); ++j)
    if (signal[static_cast<Eigen::Index>(j)] == 0) beyond[j] = false;
  return beyond;
}

}  // namespace joulepath
