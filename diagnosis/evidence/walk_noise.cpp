#include "diagnosis/evidence/walk_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0502-noise-and-scatter.md
// Method: [Yule1927], [Kalman1960]
namespace joulepath {
namespace {

/// Samples after which the filter's gain no longer changes.
constexpr Eigen::Index kSettled = 500;
/// Prior variance of the walk's level over that of the noise: the data determine it.
constexpr double kUnknownLevel = 1e4;

struct MeanSquare {
  double value{};
  std::size_t count{};
};

/// Of the channel's changes over `lag` samples.
MeanSquare change_over(const std::vector<ChannelOfRun>& runs, Eigen::Index lag) {
  MeanSquare result;
  for (const ChannelOfRun& run : runs)
    for (Eigen::Index t = lag; t < run.value.size(); ++t) {
      if (!run.present[t] || !run.present[t - lag]) continue;
      result.value += std::pow(run.value[t] - run.value[t - lag], 2);
      ++result.count;
    }
  if (result.count > 0) result.value /= static_cast<double>(result.count);
  return result;
}

/// Covariance of the walk and the last two values of the AR(2), row by row.
class Spread {
 public:
  explicit Spread(const WalkNoise& noise) : noise_(noise) {
    const auto [first, second] = noise.memory.coefficient;
    const double v = noise.memory_variance, neighbors = v * first / (1 - second);
    transition_ << 1, 0, 0, 0, first, second, 0, 1, 0;
    covariance_ << kUnknownLevel * (v + noise.step_variance), 0, 0, 0, v, neighbors, 0, neighbors, v;
    fresh_ = v - first * neighbors - second * (first * neighbors + second * v);
  }

  /// Variance of the next reading about its prediction.
  double innovation() const { return covariance_(0, 0) + 2 * covariance_(0, 1) + covariance_(1, 1); }
  /// The reading is taken in; its gain.
  Eigen::Vector3d take_in() {
    const Eigen::Vector3d with_reading = covariance_.col(0) + covariance_.col(1);
    const Eigen::Vector3d gain = with_reading / innovation();
    covariance_ -= gain * with_reading.transpose();
    return gain;
  }
  void advance() {
    covariance_ = transition_ * covariance_ * transition_.transpose();
    covariance_(0, 0) += noise_.step_variance;
    covariance_(1, 1) += fresh_;
  }

 private:
  const WalkNoise& noise_;
  Eigen::Matrix3d transition_{}, covariance_{};
  double fresh_{};  ///< variance of the AR(2)'s innovation
};

double settled_variance(const WalkNoise& noise) {
  Spread spread(noise);
  for (Eigen::Index t = 0; t < kSettled; ++t) {
    spread.take_in();
    spread.advance();
  }
  return spread.innovation();
}

}  // namespace

Autoregression fit_autoregression(const Autocovariances& lag) {
  const double rho1 = std::clamp(lag[1] / lag[0], -0.98, 0.98);
  const double rho2 = std::clamp(lag[2] / lag[0], -0.98, 0.98);
  double a1 = rho1 * (1 - rho2) / (1 - rho1 * rho1), a2 = (rho2 - rho1 * rho1) / (1 - rho1 * rho1);
  a2 = std::clamp(a2, -0.95, 0.95);
  a1 = std::clamp(a1, -0.98 * (1 - a2), 0.98 * (1 - a2));
  return {{a1, a2}, std::sqrt(std::clamp(1 - a1 * rho1 - a2 * rho2, 0.02, 1.0))};
}

WalkNoise estimate_walk(const std::vector<ChannelOfRun>& runs) {
  const MeanSquare near = change_over(runs, kShortNoiseLag), far = change_over(runs, kLongNoiseLag);
  WalkNoise noise;
  if (far.count < kLeastSamples || far.value <= near.value) return noise;
  noise.step_variance = (far.value - near.value) / static_cast<double>(kLongNoiseLag - kShortNoiseLag);
  const double variance =
      std::max(kLeastShortNoise * near.value,
               0.5 * (near.value - static_cast<double>(kShortNoiseLag) * noise.step_variance));
  if (variance <= 0) return {};
  Autocovariances lag{variance};
  for (int k = 1; k <= kAutoregressionOrder; ++k)
    lag[static_cast<std::size_t>(k)] =
        variance - 0.5 * (change_over(runs, k).value - k * noise.step_variance);
  noise.memory = fit_autoregression(lag);
  noise.memory_variance = variance;
  noise.settled_variance = settled_variance(noise);
  return noise;
}

WalkFilter::WalkFilter(const WalkNoise& noise, const Eigen::Array<bool, Eigen::Dynamic, 1>& present)
    : memory_(noise.memory),
      gain_(Eigen::Matrix3Xd::Zero(3, present.size())),
      scale_(Eigen::VectorXd::Zero(present.size())) {
  Spread spread(noise);
  for (Eigen::Index t = 0; t < present.size(); ++t) {
    if (present[t]) {
      scale_[t] = std::sqrt(noise.settled_variance / spread.innovation());
      gain_.col(t) = spread.take_in();
    }
    spread.advance();
  }
}

Eigen::VectorXd WalkFilter::innovations(const Eigen::VectorXd& value) const {
  const auto [first, second] = memory_.coefficient;
  double walk = 0, now = 0, before = 0;  // as predicted
  Eigen::VectorXd result(value.size());
  for (Eigen::Index t = 0; t < value.size(); ++t) {
    const double surprise = value[t] - walk - now;
    result[t] = scale_[t] * surprise;
    walk += gain_(0, t) * surprise;
    now += gain_(1, t) * surprise;
    before += gain_(2, t) * surprise;
    before = std::exchange(now, first * now + second * before);
  }
  return result;
}

}  // namespace joulepath
