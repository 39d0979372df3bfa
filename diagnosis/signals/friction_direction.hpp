#pragma once

#include <algorithm>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

/// Direction of rotation with which dry friction acts, -1 to 1. A measured speed is never exactly zero: near
/// standstill the direction is uncertain, and the friction grows with the speed.
inline double friction_direction(double wheel_speed_rad_s) {
  return std::clamp(wheel_speed_rad_s / kBlurredWheel_rad_s, -1.0, 1.0);
}

}  // namespace joulepath
