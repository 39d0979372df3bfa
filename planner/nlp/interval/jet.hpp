#pragma once

#include <array>
#include <cmath>
#include <cstddef>
// Design: docs/decisions/0300-path-domain.md
// Method: [GriewankWalther2008]
namespace joulepath::nlp {

/// A number with its exact first and second derivatives by N variables: forward mode.
/// `d`: gradient [N]; `dd`: lower triangle of the Hessian by rows, (0,0), (1,0), (1,1), (2,0), ...
template <std::size_t N>
struct JetOf {
  static constexpr std::size_t kTriangle = N * (N + 1) / 2;

  double value{};
  std::array<double, N> d{};
  std::array<double, kTriangle> dd{};

  constexpr JetOf() = default;
  constexpr JetOf(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor)
  constexpr JetOf(double v, const std::array<double, N>& gradient,
                  const std::array<double, kTriangle>& hessian)
      : value(v), d(gradient), dd(hessian) {}

  static constexpr JetOf variable(std::size_t index, double v) {
    JetOf x(v);
    x.d[index] = 1;
    return x;
  }

  JetOf& operator+=(const JetOf& o) { return *this = *this + o; }
  JetOf& operator-=(const JetOf& o) { return *this = *this - o; }
  JetOf& operator*=(double c) { return *this = *this * c; }

  friend constexpr JetOf operator+(const JetOf& x, const JetOf& y) {
    JetOf r(x.value + y.value);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = x.d[i] + y.d[i];
    for (std::size_t i = 0; i < kTriangle; ++i) r.dd[i] = x.dd[i] + y.dd[i];
    return r;
  }
  friend constexpr JetOf operator-(const JetOf& x, const JetOf& y) {
    JetOf r(x.value - y.value);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = x.d[i] - y.d[i];
    for (std::size_t i = 0; i < kTriangle; ++i) r.dd[i] = x.dd[i] - y.dd[i];
    return r;
  }
  friend constexpr JetOf operator*(const JetOf& x, const JetOf& y) {
    JetOf r(x.value * y.value);
    for (std::size_t i = 0, k = 0; i < N; ++i) {
      r.d[i] = x.d[i] * y.value + x.value * y.d[i];
      for (std::size_t j = 0; j <= i; ++j, ++k)
        r.dd[k] = x.dd[k] * y.value + (x.d[i] * y.d[j] + x.d[j] * y.d[i]) + x.value * y.dd[k];
    }
    return r;
  }
  friend constexpr JetOf operator*(const JetOf& x, double c) {
    JetOf r(x.value * c);
    for (std::size_t i = 0; i < N; ++i) r.d[i] = x.d[i] * c;
    for (std::size_t i = 0; i < kTriangle; ++i) r.dd[i] = x.dd[i] * c;
    return r;
  }
  friend constexpr JetOf operator-(const JetOf& x) { return x * -1.0; }
  friend constexpr JetOf operator*(double c, const JetOf& x) { return x * c; }
  friend constexpr JetOf operator+(const JetOf& x, double c) { return {x.value + c, x.d, x.dd}; }
  friend constexpr JetOf operator+(double c, const JetOf& x) { return x + c; }
  friend constexpr JetOf operator-(const JetOf& x, double c) { return x + (-c); }
  friend constexpr JetOf operator-(double c, const JetOf& x) { return -x + c; }
  friend constexpr JetOf operator/(const JetOf& x, double c) { return x * (1 / c); }
  friend JetOf operator/(const JetOf& x, const JetOf& y) { return x * y.inverse(); }
  friend JetOf operator/(double c, const JetOf& y) { return c * y.inverse(); }
  friend constexpr bool operator>(const JetOf& x, double c) { return x.value > c; }
  friend constexpr bool operator<(const JetOf& x, double c) { return x.value < c; }

  constexpr JetOf inverse() const {
    const double square = value * value;
    return through(1 / value, -1 / square, 2 / (square * value));
  }

  /// f(x) for a scalar function with value f, first derivative f1 and second derivative f2 at x.
  constexpr JetOf through(double f, double f1, double f2) const {
    JetOf r(f);
    for (std::size_t i = 0, k = 0; i < N; ++i) {
      r.d[i] = f1 * d[i];
      for (std::size_t j = 0; j <= i; ++j, ++k) r.dd[k] = f1 * dd[k] + f2 * d[i] * d[j];
    }
    return r;
  }
};

/// Derivatives by the squares of the rate at the two ends of a segment.
using Jet = JetOf<2>;

template <std::size_t N>
JetOf<N> exp(const JetOf<N>& x) {
  const double e = std::exp(x.value);
  return x.through(e, e, e);
}

/// A constant 0 (a rest end) has the root 0, without derivatives.
template <std::size_t N>
JetOf<N> sqrt(const JetOf<N>& x) {
  if (x.value <= 0) return JetOf<N>(0.0);
  const double root = std::sqrt(x.value);
  return x.through(root, 0.5 / root, -0.25 / (root * x.value));
}

/// f(x, y), with f's derivatives by these two arguments.
template <std::size_t N>
JetOf<N> composed(const Jet& f, const JetOf<N>& x, const JetOf<N>& y) {
  JetOf<N> r(f.value);
  for (std::size_t i = 0, k = 0; i < N; ++i) {
    r.d[i] = f.d[0] * x.d[i] + f.d[1] * y.d[i];
    for (std::size_t j = 0; j <= i; ++j, ++k)
      r.dd[k] = f.d[0] * x.dd[k] + f.d[1] * y.dd[k] + f.dd[0] * x.d[i] * x.d[j] +
                f.dd[1] * (x.d[i] * y.d[j] + y.d[i] * x.d[j]) + f.dd[2] * y.d[i] * y.d[j];
  }
  return r;
}

}  // namespace joulepath::nlp
