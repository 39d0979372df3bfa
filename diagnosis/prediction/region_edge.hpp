#pragma once

#include "model/operating_point.hpp"

namespace joulepath {

/// Operating point of a smoothed sample. Where the smoothing kernel reaches over the edge of an effect's
/// region of the floor, the result is the mean over the kernel, because the effect acts on a part of the
/// sample. `reach_m` is the distance that the robot travels within the kernel's standard deviation.
[[nodiscard]] Sided<WheelState<double>> operating_point_over_kernel(const Plant& plant,
                                                                    const BodyMotion<double>& motion,
                                                                    const Site& site, double reach_m);

}  // namespace joulepath
