#include "tests/planner/path/curve_laws.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace joulepath {
namespace {

// 5-point Gauss-Legendre, independent of the product's quadrature.
constexpr std::pair<double, double> kGauss5[] = {{-0.9061798459386640, 0.2369268850561891},
                                                 {-0.5384693101056831, 0.4786286704993665},
                                                 {0.0, 0.5688888888888889},
                                                 {0.5384693101056831, 0.4786286704993665},
                                                 {0.9061798459386640, 0.2369268850561891}};

struct Increments {
  double x_m{}, y_m{}, heading_rad{}, curvature_per_m{};
};

Increments integrate(const PathPiece& piece, double from_s, double to_s) {
  Increments sum;
  const double half = 0.5 * (to_s - from_s), sign = travel_sign(piece);
  for (const auto& [x, w] : kGauss5) {
    const PathPoint p = piece_point(piece, from_s + half * (1 + x));
    sum.x_m += half * w * sign * std::cos(p.pose.heading_rad);
    sum.y_m += half * w * sign * std::sin(p.pose.heading_rad);
    sum.heading_rad += half * w * p.curvature_per_m;
    sum.curvature_per_m += half * w * p.curvature_slope_per_m2;
  }
  return sum;
}

}  // namespace

CurveBreach curve_breach(const PathPiece& piece, int samples_per_stretch) {
  CurveBreach worst;
  const auto breakpoints = piece_breakpoints(piece);
  for (std::size_t i = 0; i + 1 < breakpoints.size(); ++i) {
    const double from = breakpoints[i], to = breakpoints[i + 1];
    Increments sum;
    if (i > 0) {
      const double step = piece_point(piece, from).curvature_per_m -
                          piece_point(piece, std::nextafter(from, 0)).curvature_per_m;
      worst.curvature_step_per_m = std::max(worst.curvature_step_per_m, std::abs(step));
    }
    const PathPoint begin = piece_point(piece, from);
    for (int k = 0; k < samples_per_stretch; ++k) {
      const double a = from + (to - from) * k / samples_per_stretch;
      const double b = from + (to - from) * (k + 1) / samples_per_stretch;
      const Increments d = integrate(piece, a, b);
      sum.x_m += d.x_m, sum.y_m += d.y_m, sum.heading_rad += d.heading_rad,
          sum.curvature_per_m += d.curvature_per_m;
      // Just inside of the stretch: at a breakpoint the point belongs to the next one.
      const PathPoint end = piece_point(piece, std::nextafter(b, a));
      worst.position_m = std::max(worst.position_m, std::hypot(end.pose.x_m - begin.pose.x_m - sum.x_m,
                                                               end.pose.y_m - begin.pose.y_m - sum.y_m));
      worst.heading_rad = std::max(worst.heading_rad,
                                   std::abs(end.pose.heading_rad - begin.pose.heading_rad - sum.heading_rad));
      worst.curvature_per_m = std::max(
          worst.curvature_per_m, std::abs(end.curvature_per_m - begin.curvature_per_m - sum.curvature_per_m));
    }
  }
  return worst;
}

}  // namespace joulepath
