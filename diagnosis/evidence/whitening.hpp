#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "diagnosis/evidence/walk_noise.hpp"
#include "diagnosis/prediction/rows.hpp"

namespace joulepath {

/// Noise of the structured rows, estimated from the residuals of a dataset: an AR(2) process for each
/// channel, with a random walk beside it in heading and positions, and the covariance of the innovations of
/// all channels at a sample.
struct NoiseModel {
  std::array<Autoregression, kChannelCount> memory{};  ///< where the channel has no walk
  std::array<WalkNoise, kChannelCount> walk{};
  std::array<double, kChannelCount> channel_sd{};  ///< of the smoothed channel
  Eigen::Matrix<double, kChannelCount, kChannelCount> innovation_covariance{};
};

/// Estimates the noise from rows that contain only noise (residuals of a rich fit), one entry per run. A
/// channel without data gets unit noise; `least_sd` of each channel is added in quadrature.
[[nodiscard]] NoiseModel estimate_noise(const std::vector<ResidualRows>& rows,
                                        const std::array<double, kChannelCount>& least_sd = {});

/// The same without memory and without shared noise: only the size of each channel's noise.
[[nodiscard]] NoiseModel white_noise(const std::vector<ResidualRows>& rows,
                                     const std::array<double, kChannelCount>& least_sd = {});

/// What the rows of a run add to what the rows before them tell, channel by channel.
class Innovations {
 public:
  Innovations(const NoiseModel& noise, const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>& present);

  /// One channel; 0 where the row is absent. In steady state all have the same variance.
  Eigen::VectorXd operator()(const Eigen::MatrixXd& rows, int channel) const;

 private:
  std::array<Autoregression, kChannelCount> memory_{};
  Eigen::MatrixXi history_{};  ///< samples x channels: number of present samples before, -1 = absent
  std::array<std::optional<WalkFilter>, kChannelCount> walk_{};
};

/// Turns rows into uncorrelated entries of unit variance. The same pattern of presence gives the same
/// order of entries, so that signatures and residuals of a run match.
class Whitener {
 public:
  Whitener(const NoiseModel& noise, const Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>& present);

  Eigen::Index entries() const { return entries_; }
  /// Channel of each entry.
  const std::vector<int>& channel_of_entry() const { return channel_of_entry_; }
  Eigen::VectorXd operator()(const Eigen::MatrixXd& rows) const;

 private:
  struct Pattern {
    std::vector<int> channels{};
    Eigen::MatrixXd inverse_factor{};  ///< lower triangular
  };
  Innovations innovations_;
  std::vector<Pattern> patterns_{};
  std::vector<int> pattern_of_sample_{};
  std::vector<int> channel_of_entry_{};
  Eigen::Index entries_{};
};

}  // namespace joulepath
