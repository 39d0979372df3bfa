#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sided.hpp"

namespace joulepath {

/// Sums of squares of an acceleration where it stands out of its noise, and of the noise there.
struct NoisySquares {
  double all{}, noise{};
  NoisySquares& operator+=(const NoisySquares& other) {
    all += other.all, noise += other.noise;
    return *this;
  }
  [[nodiscard]] double noise_share() const { return all > 0 ? noise / all : 0.0; }
};
/// Of the wheels' mean and of half their difference.
struct NoisyModes {
  NoisySquares driving{}, turning{};
};

/// Takes the encoders' noise out of accelerations: of the wheels' mean (driving) and half their difference
/// (turning), each by itself. Where the mean square of the samples within kAccelerationWindow_s of one is at
/// least kAccelerationOverNoise times the noise, the sample counts; elsewhere their mean counts, where it
/// stands out of its own noise, and else nothing. The noise is that of the third differences of the
/// accelerations themselves, by the median: that of a signal that mostly repeats its values is 0, and it
/// stays as it is. `third_difference_gain`: variance of a third difference of the noise over that of the
/// noise, 20 if it is white; `mean_gain`: the same of such a mean. Samples further apart than
/// kLongestNoisePeriod_s stay as they are. Returns what stands out.
NoisyModes remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2,
                                     double third_difference_gain, double period_s, double mean_gain);

/// Jerks that do not stand out of their noise are set to zero. They come in short peaks: three samples count.
void remove_jerk_noise(Sided<Eigen::VectorXd>& jerk_rad_s3, double third_difference_gain);

/// Samples at which a signal stands out of its noise, by the same measure as accelerations; all where samples
/// are too far apart.
[[nodiscard]] std::vector<bool> beyond_noise(const Eigen::VectorXd& signal, double third_difference_gain,
                                             double period_s);

}  // namespace joulepath
