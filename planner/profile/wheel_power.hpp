#pragma once

#include <cmath>
#include <limits>

namespace joulepath {

/// c0 + c1 x + c2 x^2.
struct Quadratic {
  double c0{}, c1{}, c2{};

  double operator()(double x) const { return c0 + x * (c1 + x * c2); }
};

/// at_0 + slope x.
struct Line {
  double at_0{};
  double slope{};

  double operator()(double x) const { return at_0 + slope * x; }
  Quadratic operator*(const Line& o) const {
    return {at_0 * o.at_0, at_0 * o.slope + slope * o.at_0, slope * o.slope};
  }
  Line operator+(const Line& o) const { return {at_0 + o.at_0, slope + o.slope}; }
  friend Line operator*(double c, const Line& x) { return {c * x.at_0, c * x.slope}; }
};

/// One wheel as a function of the acceleration at a given place and rate. The electrical power is quadratic
/// on both sides of a kink, where the torque behind the gear changes its sign.
struct WheelPower {
  Quadratic below{}, above{};
  double kink{std::numeric_limits<double>::infinity()};  ///< infinite: no kink
  Line current_A{}, voltage_V{}, force_N{};              ///< current and voltage only where there is none

  bool bent() const { return std::isfinite(kink); }
  double operator()(double a) const { return a < kink ? below(a) : above(a); }
};

}  // namespace joulepath
