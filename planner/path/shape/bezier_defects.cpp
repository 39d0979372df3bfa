#include <algorithm>
#include <cmath>
#include <cstdio>

#include "planner/path/geometry/bezier_geometry.hpp"
#include "planner/path/geometry/rounding.hpp"
#include "planner/path/shape/bezier_chain.hpp"

namespace joulepath {
namespace {

using Kind = BezierFinding::Kind;

// |B'| below this share of the control polygon's length counts as vanishing: the curve's radius there is
// about the square of it.
constexpr double kVanishing = 1e-3;
constexpr int kSamples = 128;

BezierFinding finding(Kind kind, const BezierPoints& p, std::size_t curve, double t, const char* what) {
  const BezierDerivatives d = bezier_derivatives(p, t);
  char text[256];
  std::snprintf(text, sizeof text, "curve %zu at t = %.4g (%.4g, %.4g) m: %s", curve, t, d.position_m[0],
                d.position_m[1], what);
  return {kind, curve, t, d.position_m[0], d.position_m[1], 0, text};
}

double squared_speed(const BezierPoints& p, double t) {
  const BezierDerivatives d = bezier_derivatives(p, t);
  return d.first_m[0] * d.first_m[0] + d.first_m[1] * d.first_m[1];
}

/// Narrows the smallest squared speed between two parameters by golden section.
double slowest_parameter(const BezierPoints& p, double from_t, double to_t) {
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < 60; ++i) {
    const double a = to_t - kGolden * (to_t - from_t), b = from_t + kGolden * (to_t - from_t);
    if (squared_speed(p, a) < squared_speed(p, b)) {
      to_t = b;
    } else {
      from_t = a;
    }
  }
  return 0.5 * (from_t + to_t);
}

/// Turning points of a curve whose control points lie on a line: roots of the projected derivative.
std::vector<double> turning_parameters_on_a_line(const BezierPoints& p) {
  const auto from_start_m = [&](std::size_t i) { return std::hypot(p[i][0] - p[0][0], p[i][1] - p[0][1]); };
  // A closed curve on a line must turn back somewhere: project on its farther handle instead.
  const bool closed = from_start_m(3) <= kVanishing * control_polygon_length_m(p);
  const std::size_t end = !closed ? 3 : from_start_m(1) > from_start_m(2) ? 1 : 2;
  const double ux = p[end][0] - p[0][0], uy = p[end][1] - p[0][1];
  const auto step = [&](std::size_t i) {
    return (p[i + 1][0] - p[i][0]) * ux + (p[i + 1][1] - p[i][1]) * uy;
  };
  const double c = step(0), b = 2 * (step(1) - step(0)), a = step(0) - 2 * step(1) + step(2);
  std::vector<double> roots;
  const double discriminant = b * b - 4 * a * c;
  const double size = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (discriminant <= 1e-12 * size * size) return roots;  // no root, or a double one: no turning back
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  for (const double t : {q / a, c / q})
    if (std::isfinite(t) && t > 1e-9 && t < 1 - 1e-9) roots.push_back(t);
  std::sort(roots.begin(), roots.end());
  return roots;
}

}  // namespace

std::vector<BezierFinding> bezier_defects(const BezierPoints& p, std::size_t curve) {
  for (const auto& point : p)
    if (!std::isfinite(point[0]) || !std::isfinite(point[1]))
      return {{Kind::not_finite, curve, 0, 0, 0, 0,
               "curve " + std::to_string(curve) + ": a control point is not finite"}};
  const double scale_m = control_polygon_length_m(p);
  if (scale_m < kRounding_m)
    return {finding(Kind::no_length, p, curve, 0, "all control points coincide within 1 mm")};
  std::vector<BezierFinding> defects;
  if (on_a_line(p)) {
    for (const double t : turning_parameters_on_a_line(p))
      defects.push_back(finding(Kind::cusp, p, curve, t, "the curve turns back on its own line"));
    return defects;
  }
  const double limit = std::pow(kVanishing * scale_m, 2);
  if (squared_speed(p, 0) < limit)
    defects.push_back(finding(Kind::unbounded_curvature, p, curve, 0,
                              "p0 == p1 on a curve that bends: infinite curvature"));
  for (int i = 1; i < kSamples; ++i) {
    const double t = static_cast<double>(i) / kSamples, before = t - 1.0 / kSamples,
                 after = t + 1.0 / kSamples;
    const double here = squared_speed(p, t);
    if (here > squared_speed(p, before) || here > squared_speed(p, after)) continue;
    const double slowest_t = slowest_parameter(p, before, after);
    if (squared_speed(p, slowest_t) < limit)
      defects.push_back(
          finding(Kind::cusp, p, curve, slowest_t, "cusp: the tangent vanishes inside of the curve"));
  }
  if (squared_speed(p, 1) < limit)
    defects.push_back(finding(Kind::unbounded_curvature, p, curve, 1,
                              "p2 == p3 on a curve that bends: infinite curvature"));
  return defects;
}

}  // namespace joulepath
