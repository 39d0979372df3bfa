#pragma once

#include <vector>

namespace joulepath {

/// A channel behind a first-order low pass, T dy/dt = x - y from y = x at the first sample, x linear between
/// samples. Wheel speeds that such a filter smoothed are compared with readings that it smoothed as well.
[[nodiscard]] std::vector<double> behind_velocity_filter(std::vector<double> channel, double period_s,
                                                         double time_constant_s);

}  // namespace joulepath
