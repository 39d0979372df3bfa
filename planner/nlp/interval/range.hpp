#pragma once

#include <algorithm>
#include <cmath>

// Method: [Moore1966]
namespace joulepath::nlp {

/// Interval arithmetic: the range of a row over a box. A row that cannot reach its limit is left out of the
/// problem.
struct Range {
  double low{};
  double high{};

  constexpr Range() = default;
  constexpr Range(double constant) : low(constant), high(constant) {}  // NOLINT(google-explicit-constructor)
  constexpr Range(double l, double h) : low(l), high(h) {}

  friend constexpr Range operator-(const Range& x) { return {-x.high, -x.low}; }
  friend constexpr Range operator+(const Range& x, const Range& y) {
    return {x.low + y.low, x.high + y.high};
  }
  friend constexpr Range operator-(const Range& x, const Range& y) { return x + (-y); }
  friend constexpr Range operator*(const Range& x, const Range& y) {
    const double p[] = {x.low * y.low, x.low * y.high, x.high * y.low, x.high * y.high};
    return {std::min({p[0], p[1], p[2], p[3]}), std::max({p[0], p[1], p[2], p[3]})};
  }
  friend constexpr Range operator*(double c, const Range& x) { return Range(c) * x; }
  Range& operator+=(const Range& o) { return *this = *this + o; }
};

inline Range sqrt(const Range& x) {
  return {std::sqrt(std::max(0.0, x.low)), std::sqrt(std::max(0.0, x.high))};
}

}  // namespace joulepath::nlp
