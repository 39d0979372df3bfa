#pragma once

#include <vector>

namespace joulepath {

/// A channel behind a first-order low pass, T dy/dt = x - y from y = x at the first sample, x linear between
/// samples. Wheel speeds that such a filter smoothed are compared with readings that it smoothed as well.
[[nodiscard]] std::vector<double> behind_velocity_filter(std::vector<double> channel,
                                                         const std::vector<double>& time_s,
                                                         double time_constant_s);

/// What such a filter was given, as means over the two periods beside each sample: from a rest on it is zero.
[[nodiscard]] std::vector<double> before_velocity_filter(const std::vector<double>& filtered,
                                                         const std::vector<double>& time_s,
                                                         double time_constant_s);

}  // namespace joulepath
