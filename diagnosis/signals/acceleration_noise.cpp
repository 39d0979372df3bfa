#include "diagnosis/signals/acceleration_noise.hpp"

#include <algorithm>
#include <cmath>
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
  return upper_median(squares) / (kMedianOfChiSquare * third_difference_gain);
}

/// The samples within half a window of one.
Eigen::VectorXd window(const Eigen::VectorXd& mode, Eigen::Index at, Eigen::Index half_width) {
  const Eigen::Index first = std::max<Eigen::Index>(0, at - half_width);
  return mode.segment(first, std::min(mode.size(), at + half_width + 1) - first);
}

/// Sets to zero the samples about which the mean square is below so many variances of the noise.
Eigen::VectorXd above_noise(const Eigen::VectorXd& mode, double variance, Eigen::Index half_width,
                            double over_noise) {
  Eigen::VectorXd kept = mode;
  for (Eigen::Index j = 0; j < mode.size(); ++j) {
    const Eigen::VectorXd near = window(mode, j, half_width);
    if (near.squaredNorm() < over_noise * variance * static_cast<double>(near.size())) kept[j] = 0;
  }
  return kept;
}

Eigen::Index half_window(double period_s) { return std::lround(kAccelerationWindow_s / period_s); }

/// What is expected of an acceleration behind its reading, so that the reading's noise is no evidence against
/// an inertia: where it stands out of its noise, the share of it that is no noise on average; elsewhere the
/// mean of the window, where that stands out. The noise of a mean is that of the speeds at the window's ends:
/// its variance is (2 sigma / T)^2 that of a sample under a Gaussian kernel.
Eigen::VectorXd expected(const Eigen::VectorXd& mode, const Eigen::VectorXd& kept, double variance,
                         double period_s, double kernel_sigma_s) {
  Eigen::VectorXd result = kept;
  for (Eigen::Index j = 0; j < mode.size(); ++j) {
    const Eigen::VectorXd near = window(mode, j, half_window(period_s));
    const double square = near.squaredNorm() / static_cast<double>(near.size()), mean = near.mean(),
                 ends = 2 * kernel_sigma_s / (static_cast<double>(near.size()) * period_s);
    if (kept[j] != 0)
      result[j] *= std::max(0.0, 1 - variance / square);
    else if (mean * mean > kMeanOverNoise * variance * std::min(1.0, ends * ends))
      result[j] = mean;
  }
  return result;
}

struct Mode {
  Eigen::VectorXd value{}, kept{};  ///< all; zero where it does not stand out of its noise
  double variance{};
  [[nodiscard]] NoisySquares squares() const {
    return {.all = kept.squaredNorm(), .noise = variance * static_cast<double>((kept.array() != 0).count())};
  }
};

Mode mode_of(const Eigen::VectorXd& value, double third_difference_gain, Eigen::Index half_width,
             double over_noise) {
  const double variance = noise_variance(value, third_difference_gain);
  return {value, above_noise(value, variance, half_width, over_noise), variance};
}

Eigen::VectorXd driving(const Sided<Eigen::VectorXd>& wheels) { return 0.5 * (wheels.left + wheels.right); }
Eigen::VectorXd turning(const Sided<Eigen::VectorXd>& wheels) { return 0.5 * (wheels.right - wheels.left); }

}  // namespace

NoisyModes remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2,
                                     double third_difference_gain, double period_s, double kernel_sigma_s) {
  if (period_s > kLongestNoisePeriod_s) return {};
  const auto mode = [&](const Eigen::VectorXd& value) {
    return mode_of(value, third_difference_gain, half_window(period_s), kAccelerationOverNoise);
  };
  const auto without_noise = [&](const Mode& of) {
    return expected(of.value, of.kept, of.variance, period_s, kernel_sigma_s);
  };
  const Mode drive = mode(driving(acceleration_rad_s2)), turn = mode(turning(acceleration_rad_s2));
  const Eigen::VectorXd along = without_noise(drive), around = without_noise(turn);
  acceleration_rad_s2 = {along - around, along + around};
  return {drive.squares(), turn.squares()};
}

void remove_jerk_noise(Sided<Eigen::VectorXd>& jerk_rad_s3, double third_difference_gain) {
  const auto kept = [&](const Eigen::VectorXd& value) {
    return mode_of(value, third_difference_gain, 1, kJerkOverNoise).kept;
  };
  const Eigen::VectorXd along = kept(driving(jerk_rad_s3)), around = kept(turning(jerk_rad_s3));
  jerk_rad_s3 = {along - around, along + around};
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
