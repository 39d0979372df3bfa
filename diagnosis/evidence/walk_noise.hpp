#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace joulepath {

inline constexpr int kAutoregressionOrder = 2;
/// Autocovariances at the lags 0 to kAutoregressionOrder.
using Autocovariances = std::array<double, 3>;
static_assert(std::tuple_size_v<Autocovariances> == kAutoregressionOrder + 1);

/// x_t = coefficient[0] x_(t-1) + coefficient[1] x_(t-2) + innovation.
struct Autoregression {
  std::array<double, kAutoregressionOrder> coefficient{};
  double innovation_ratio{1.0};  ///< sd of the innovation / sd of x
};

/// Yule-Walker equations for two lags; the variance is positive.
[[nodiscard]] Autoregression fit_autoregression(const Autocovariances& lag);

/// Noise of a channel that integrates: a random walk beside an AR(2) process. In the channel's unit, squared.
struct WalkNoise {
  double step_variance{};  ///< of the walk, per sample; 0: no walk
  Autoregression memory{};
  double memory_variance{};   ///< of the AR(2) process
  double settled_variance{};  ///< of the innovation, long after a run's start
};

/// One channel of one run.
struct ChannelOfRun {
  Eigen::VectorXd value{};
  Eigen::Array<bool, Eigen::Dynamic, 1> present{};
};

/// From the mean squares of the changes over few and over many samples. Without a walk where these do not
/// grow, or where there are fewer than kLeastSamples of them.
[[nodiscard]] WalkNoise estimate_walk(const std::vector<ChannelOfRun>& runs);

/// Kalman filter of a WalkNoise: turns a channel of a run into uncorrelated innovations. It is linear, so
/// that residuals and signatures pass through the same filter. The walk's level at a run's start is unknown.
class WalkFilter {
 public:
  WalkFilter(const WalkNoise& noise, const Eigen::Array<bool, Eigen::Dynamic, 1>& present);

  /// Each innovation, scaled to the settled variance; 0 where the row is absent.
  Eigen::VectorXd innovations(const Eigen::VectorXd& value) const;

 private:
  Autoregression memory_;
  Eigen::Matrix3Xd gain_;  ///< of the walk and the last two values of the AR(2); 0 where the row is absent
  Eigen::VectorXd scale_;  ///< of each innovation
};

}  // namespace joulepath
