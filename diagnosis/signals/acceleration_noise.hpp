#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sided.hpp"

namespace joulepath {

/// Variance of a channel's white noise, from the median of its squared third differences; 0 for a channel
/// that mostly repeats its values.
[[nodiscard]] double white_noise_variance(const std::vector<double>& samples);

/// Sets to zero what is no more than the encoders' noise: of the wheels' mean acceleration (driving) and half
/// their difference (turning), each by itself, the samples about which the mean square stays below
/// kAccelerationOverNoise times the noise. `variance`: noise of one wheel's acceleration, (rad/s^2)^2.
void remove_acceleration_noise(Sided<Eigen::VectorXd>& acceleration_rad_s2, double variance, double period_s);

}  // namespace joulepath
