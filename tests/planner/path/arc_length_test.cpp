#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "planner/path/geometry/bezier.hpp"

namespace joulepath {
namespace {

using Real = long double;
using Speed = std::function<Real(Real t)>;

/// Gauss-Legendre with three points, on halves until they agree: independent of the product's quadrature.
Real three_points(const Speed& speed, Real a, Real b) {
  const Real middle = 0.5L * (a + b), half = 0.5L * (b - a), x = std::sqrt(0.6L) * half;
  return half / 9 * (8 * speed(middle) + 5 * (speed(middle - x) + speed(middle + x)));
}
Real integral(const Speed& speed, Real a, Real b, Real whole, Real tolerance, int depth = 0) {
  const Real middle = 0.5L * (a + b);
  const Real left = three_points(speed, a, middle), right = three_points(speed, middle, b);
  if (std::abs(left + right - whole) <= tolerance || depth == 50) return left + right;
  return integral(speed, a, middle, left, tolerance, depth + 1) +
         integral(speed, middle, b, right, tolerance, depth + 1);
}
Real integral(const Speed& speed, Real a, Real b, Real tolerance) {
  return integral(speed, a, b, three_points(speed, a, b), tolerance);
}

/// The largest difference between an arc length and the integral of the speed up to its parameter, over
/// places in ascending order, and at the end.
double worst_arc_m(const BezierSegment& curve, const Speed& speed, Real tolerance_m, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> places_m{curve.length_m()};
  for (int i = 0; i < 150; ++i) places_m.push_back(curve.length_m() * share(random));
  std::sort(places_m.begin(), places_m.end());
  Real worst_m = 0, arc_m = 0, before_t = 0;
  for (const double s_m : places_m) {
    const double t = curve.parameter(s_m);
    EXPECT_GT(t, static_cast<double>(before_t));
    arc_m += integral(speed, before_t, t, tolerance_m);
    worst_m = std::max(worst_m, std::abs(arc_m - static_cast<Real>(s_m)));
    before_t = t;
  }
  EXPECT_NEAR(static_cast<double>(before_t), 1, 1e-15);
  return static_cast<double>(worst_m);
}

double polygon_m(const BezierPoints& p) {
  double sum_m = 0;
  for (std::size_t i = 0; i < 3; ++i) sum_m += std::hypot(p[i + 1][0] - p[i][0], p[i + 1][1] - p[i][1]);
  return sum_m;
}

/// B' of a cubic in long double.
Speed speed_of(const BezierPoints& p) {
  return [p](Real t) {
    const Real u = 1 - t;
    Real square = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const Real p0 = p[0][k], p1 = p[1][k], p2 = p[2][k], p3 = p[3][k];
      const Real d = 3 * (u * u * (p1 - p0) + 2 * u * t * (p2 - p1) + t * t * (p3 - p2));
      square += d * d;
    }
    return std::sqrt(square);
  };
}

/// A random cubic whose derivative is `least_m` long at one parameter.
BezierPoints nearly_cusped(double least_m, std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1), inside(0, 1), angle(-3, 3);
  const double t = inside(random), u = 1 - t, direction_rad = angle(random);
  const double aim_m[2] = {least_m * std::cos(direction_rad), least_m * std::sin(direction_rad)};
  BezierPoints p{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double d0 = coordinate(random), d2 = coordinate(random);
    // B' = 3 (u² d0 + 2 u t d1 + t² d2)
    const double d1 = (aim_m[k] / 3 - u * u * d0 - t * t * d2) / std::max(2 * u * t, 0.1);
    p[1][k] = d0;
    p[2][k] = d0 + d1;
    p[3][k] = d0 + d1 + d2;
  }
  return p;
}

TEST(ArcLength, IsTheIntegralOfTheSpeedUpToItsParameter) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  for (int trial = 0; trial < 60; ++trial) {
    BezierPoints p{};
    for (auto& point : p) point = {coordinate(random), coordinate(random)};
    const double scale_m = polygon_m(p);
    EXPECT_LT(worst_arc_m(BezierSegment(p), speed_of(p), 1e-16 * scale_m, random), 1e-13 * scale_m) << trial;
  }
}

TEST(ArcLength, IsExactBesideACusp) {
  std::mt19937 random(6);
  for (const double least_m : {0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5})
    for (int trial = 0; trial < 10; ++trial) {
      const BezierPoints p = nearly_cusped(least_m, random);
      const double scale_m = polygon_m(p);
      EXPECT_LT(worst_arc_m(BezierSegment(p), speed_of(p), 1e-16 * scale_m, random), 1e-13 * scale_m)
          << least_m << ", " << trial;
    }
}

TEST(ArcLength, OfARationalCurveIsExactToo) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-2, 2), weight(0.3, 3);
  for (int trial = 0; trial < 20; ++trial) {
    RationalBezier curve;
    for (int i = 0; i <= 3 + trial % 3; ++i) {
      const double w = weight(random);
      curve.points.push_back({w * coordinate(random), w * coordinate(random), w});
    }
    const Speed speed = [&](Real t) {
      const auto first = bezier_derivatives(curve, static_cast<double>(t)).first_m;
      return static_cast<Real>(std::hypot(first[0], first[1]));
    };
    // The speed itself has only double precision.
    const double scale_m = curve.polygon_length_m();
    EXPECT_LT(worst_arc_m(BezierSegment::rational(curve), speed, 1e-14 * scale_m, random), 1e-12 * scale_m)
        << trial;
  }
}

TEST(BezierCurvature, IsBelowItsBound) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  int near = 0, told = 0;
  for (int i = 0; i < 300; ++i) {
    const double dx = coordinate(random), dy = coordinate(random);
    const BezierSegment curve({{{0, 0}, {1, 0}, {2 + dx, dy}, {3, coordinate(random)}}});
    const double bound = curve.curvature_bound_per_m();
    if (std::isinf(bound)) continue;
    ++told;
    double most = 0;
    for (int k = 0; k <= 200; ++k)
      most = std::max(most, std::abs(curve.bend(curve.length_m() * k / 200).curvature_per_m));
    EXPECT_LE(most, bound * (1 + 1e-9));
    near += most > 0.3 * bound;
  }
  EXPECT_GT(told, 250);
  EXPECT_GT(near, 150);
}

}  // namespace
}  // namespace joulepath
