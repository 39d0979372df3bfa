#include <array>
#include <cmath>

#include "planner/path/shape/refine.hpp"

namespace joulepath {
namespace {

constexpr double kShortestPiece_m = 0.01;
constexpr double kSharpest_rad = 2.7;
constexpr double kStraight_rad = 1e-6;

Point2 along(const Point2& from, const Point2& unit, double length_m) {
  return {from[0] + length_m * unit[0], from[1] + length_m * unit[1]};
}

Point2 mix(double a, const Point2& p, double b, const Point2& q, double c, const Point2& r) {
  return {a * p[0] + b * q[0] + c * r[0], a * p[1] + b * q[1] + c * r[1]};
}

/// The Bezier form of one span of a uniform cubic B-spline.
BezierPoints span(const Point2& p, const Point2& q, const Point2& r, const Point2& s) {
  return {mix(1.0 / 6, p, 4.0 / 6, q, 1.0 / 6, r), mix(0, p, 2.0 / 3, q, 1.0 / 3, r),
          mix(1.0 / 3, q, 2.0 / 3, r, 0, s), mix(1.0 / 6, q, 4.0 / 6, r, 1.0 / 6, s)};
}

}  // namespace

double spline_tangent_m(const SplineCorner& corner, double turn_rad, bool before) {
  const double a = corner.before_m, b = corner.after_m;
  const double chord_m = std::sqrt(std::max(0.0, a * a + b * b + 2 * a * b * std::cos(turn_rad)));
  return (before ? a : b) + chord_m;
}

std::optional<Path> spline_path(const Point2& start_m, const std::vector<SplineCorner>& corners,
                                const Point2& goal_m) {
  std::vector<CurveSegment> segments;
  Point2 here = start_m;
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    const Point2& next = i < corners.size() ? corners[i].vertex_m : goal_m;
    const Point2& anchor = i == 0 ? start_m : corners[i - 1].vertex_m;
    const double heading_rad = std::atan2(next[1] - anchor[1], next[0] - anchor[0]);
    const Point2 in{std::cos(heading_rad), std::sin(heading_rad)};
    double before_m = 0, after_m = 0, out_rad = heading_rad;
    if (i < corners.size()) {
      const Point2& beyond = i + 1 < corners.size() ? corners[i + 1].vertex_m : goal_m;
      out_rad = std::atan2(beyond[1] - next[1], beyond[0] - next[0]);
      const double turn_rad = std::abs(wrapped_angle_rad(out_rad - heading_rad));
      if (turn_rad > kSharpest_rad || turn_rad < kStraight_rad || corners[i].before_m <= 0 ||
          corners[i].after_m <= 0)
        return std::nullopt;
      before_m = spline_tangent_m(corners[i], turn_rad, true);
      after_m = spline_tangent_m(corners[i], turn_rad, false);
    }
    const double straight_m = (next[0] - here[0]) * in[0] + (next[1] - here[1]) * in[1] - before_m;
    if (!(straight_m >= kShortestPiece_m)) return std::nullopt;
    segments.push_back(LinearCurvature({here[0], here[1], heading_rad}, straight_m));
    if (i == corners.size()) break;
    const Point2 out{std::cos(out_rad), std::sin(out_rad)};
    const double spacing_m = before_m - corners[i].before_m;
    std::array<Point2, 6> control;
    for (std::size_t k = 0; k < 3; ++k) {
      control[k] = along(next, in, -corners[i].before_m - spacing_m * static_cast<double>(2 - k));
      control[3 + k] = along(next, out, corners[i].after_m + spacing_m * static_cast<double>(k));
    }
    for (std::size_t k = 0; k < 3; ++k)
      segments.push_back(BezierSegment(span(control[k], control[k + 1], control[k + 2], control[k + 3])));
    here = along(next, out, after_m);
  }
  return Path{{Curve(std::move(segments))}};
}

}  // namespace joulepath
