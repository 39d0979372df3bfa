#pragma once

#include <cmath>

namespace joulepath::nlp {

/// A number with its exact first and second derivatives by two variables (the squares of the rate at the
/// two ends of a segment): forward mode, six doubles.
struct Jet {
  double value{};
  double d0{}, d1{};
  double d00{}, d01{}, d11{};

  constexpr Jet() = default;
  constexpr Jet(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor)
  constexpr Jet(double v, double g0, double g1, double h00, double h01, double h11)
      : value(v), d0(g0), d1(g1), d00(h00), d01(h01), d11(h11) {}

  static constexpr Jet variable0(double v) { return {v, 1, 0, 0, 0, 0}; }
  static constexpr Jet variable1(double v) { return {v, 0, 1, 0, 0, 0}; }

  Jet& operator+=(const Jet& o) { return *this = *this + o; }
  Jet& operator-=(const Jet& o) { return *this = *this - o; }
  Jet& operator*=(double c) { return *this = *this * c; }

  friend constexpr Jet operator-(const Jet& x) { return {-x.value, -x.d0, -x.d1, -x.d00, -x.d01, -x.d11}; }
  friend constexpr Jet operator+(const Jet& x, const Jet& y) {
    return {x.value + y.value, x.d0 + y.d0, x.d1 + y.d1, x.d00 + y.d00, x.d01 + y.d01, x.d11 + y.d11};
  }
  friend constexpr Jet operator-(const Jet& x, const Jet& y) {
    return {x.value - y.value, x.d0 - y.d0, x.d1 - y.d1, x.d00 - y.d00, x.d01 - y.d01, x.d11 - y.d11};
  }
  friend constexpr Jet operator*(const Jet& x, const Jet& y) {
    return {x.value * y.value,
            x.d0 * y.value + x.value * y.d0,
            x.d1 * y.value + x.value * y.d1,
            x.d00 * y.value + 2 * x.d0 * y.d0 + x.value * y.d00,
            x.d01 * y.value + x.d0 * y.d1 + x.d1 * y.d0 + x.value * y.d01,
            x.d11 * y.value + 2 * x.d1 * y.d1 + x.value * y.d11};
  }
  friend constexpr Jet operator*(const Jet& x, double c) {
    return {x.value * c, x.d0 * c, x.d1 * c, x.d00 * c, x.d01 * c, x.d11 * c};
  }
  friend constexpr Jet operator*(double c, const Jet& x) { return x * c; }
  friend constexpr Jet operator+(const Jet& x, double c) {
    return {x.value + c, x.d0, x.d1, x.d00, x.d01, x.d11};
  }
  friend constexpr Jet operator+(double c, const Jet& x) { return x + c; }
  friend constexpr Jet operator-(const Jet& x, double c) { return x + (-c); }
  friend constexpr Jet operator-(double c, const Jet& x) { return -x + c; }
  friend constexpr Jet operator/(const Jet& x, double c) { return x * (1 / c); }
  friend Jet operator/(const Jet& x, const Jet& y) {
    return x * y.through(1 / y.value, -1 / (y.value * y.value), 2 / (y.value * y.value * y.value));
  }
  friend Jet operator/(double c, const Jet& y) {
    return c * y.through(1 / y.value, -1 / (y.value * y.value), 2 / (y.value * y.value * y.value));
  }
  friend constexpr bool operator>(const Jet& x, double c) { return x.value > c; }
  friend constexpr bool operator<(const Jet& x, double c) { return x.value < c; }

  /// f(x) for a scalar function with value f, first derivative f1, second derivative f2 here.
  constexpr Jet through(double f, double f1, double f2) const {
    return {f, f1 * d0, f1 * d1, f1 * d00 + f2 * d0 * d0, f1 * d01 + f2 * d0 * d1, f1 * d11 + f2 * d1 * d1};
  }
};

inline Jet exp(const Jet& x) {
  const double e = std::exp(x.value);
  return x.through(e, e, e);
}

/// A constant 0 (a rest end) has the root 0, without derivatives.
inline Jet sqrt(const Jet& x) {
  if (x.value <= 0) return Jet(0.0);
  const double root = std::sqrt(x.value);
  return x.through(root, 0.5 / root, -0.25 / (root * x.value));
}

}  // namespace joulepath::nlp
