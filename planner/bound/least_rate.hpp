#pragma once

#include "planner/bound/power_form.hpp"

namespace joulepath {

/// Prices of a motion at one place of its clock, the arc length sigma:
///   X = p(sigma) v^2 - g K_rot(omega) + ... ,   and q per radian of heading.
struct MotionPrice {
  double p{};                 ///< J/(m/s)^2
  double p_slope{};           ///< dp/dsigma
  double per_rad_J{};         ///< q
  double spin{};              ///< g in [0, 1]: credit for the energy of rotation
  double time_W{};            ///< price of a second beside the standby power
  double most_m_s{kNoLimit};  ///< speed that can be reached at the place
};

/// A certified lower bound (J/m) of
///   min over |v|, omega, a, alpha within the limits of [(L - g dK_rot/dt - q omega)/|v| + p' v^2 + 2 p a],
/// minus infinity where turning in place alone makes it so. Branch and bound over (m, x) of each sector: for
/// fixed weights of both wheels' powers in [eta, 1] the least over (a, alpha) is exact, and the function lies
/// above its bilinear interpolation less 1/8 of each step's square times a bound of the second derivative. No
/// value is rounded to a grid; `tolerance` (J/m) says only when to stop.
[[nodiscard]] double least_rate(const PowerForm& form, const MotionPrice& price, double tolerance);

}  // namespace joulepath
