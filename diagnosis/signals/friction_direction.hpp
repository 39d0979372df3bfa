#pragma once

#include <algorithm>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

/// Sign of a value that is uncertain within `width`.
inline double soft_sign(double value, double width) { return std::clamp(value / width, -1.0, 1.0); }

/// Direction of rotation with which dry friction acts, -1 to 1. A measured speed is never exactly zero: below
/// `blurred_rad_s` the direction is uncertain, and the friction grows with the speed.
inline double friction_direction(double wheel_speed_rad_s, double blurred_rad_s = kBlurredWheel_rad_s) {
  return soft_sign(wheel_speed_rad_s, blurred_rad_s);
}

}  // namespace joulepath
