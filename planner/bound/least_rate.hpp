#pragma once

#include "planner/bound/power_form.hpp"

namespace joulepath {

/// What X refunds to a turning robot: a share g of the energy of rotation, and h for each m/s at which its
/// inner wheel rolls backward. Without h, a wheel that slows down while it rolls backward looks as if its
/// friction drove the robot for nothing.
struct TurnCredit {
  double spin{};   ///< g >= 0
  double inner{};  ///< h >= 0, J/(m/s)
};

/// Prices of a motion at one place of its clock, the arc length sigma:
///   X = p(sigma) v^2 - g K_rot(omega) - h max(0, l |omega| - |v|) .
struct MotionPrice {
  double p{};        ///< J/(m/s)^2
  double p_slope{};  ///< dp/dsigma
  TurnCredit credit{};
  double time_W{};            ///< price of a second beside the standby power
  double most_m_s{kNoLimit};  ///< speed that can be reached at the place
};

/// A certified lower bound (J/m) of
///   min over |v|, omega, a, alpha within the limits of [(L + dX/dt - q omega)/|v|]
/// for each price q of a radian of heading (at most kMostHeadingPrices of them), minus infinity where turning
/// in place alone makes it so. Branch and bound over (m, x) of each sector: for fixed weights of both wheels'
/// powers in [eta, 1] the least over (a, alpha) is exact, and the function lies above its bilinear
/// interpolation less 1/8 of each step's square times a bound of the second derivative. No value is rounded
/// to a grid; `tolerance` (J/m) says only when to stop.
[[nodiscard]] std::vector<double> least_rates(const PowerForm& form, const MotionPrice& price,
                                              const std::vector<double>& per_rad_J, double tolerance);
inline constexpr int kMostHeadingPrices = 32;

/// The same where the heading is free: q = 0.
[[nodiscard]] double least_rate(const PowerForm& form, const MotionPrice& price, double tolerance);

/// The price (J) of a radian of heading above which turning in place pays; sampled, not certified.
[[nodiscard]] double turning_price(const PowerForm& form, const TurnCredit& credit, double time_W);

}  // namespace joulepath
