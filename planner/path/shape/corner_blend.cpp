#include "planner/path/shape/corner_blend.hpp"

#include <cmath>
#include <numbers>

#include "model/assert.hpp"
// Design: docs/decisions/0200-paths.md
// Method: [ShinSingh1990]
namespace joulepath {
namespace {

// Clothoid from curvature 0 to 1 through share * angle: heading = length / 2.
double clothoid_length(double angle) { return 2 * BlendShape::kClothoidShare * angle; }
double arc_length(double angle) { return (1 - 2 * BlendShape::kClothoidShare) * angle; }

}  // namespace

BlendShape blend_shape(double angle_rad) {
  const double angle = std::abs(angle_rad);
  JOULEPATH_ASSERT(angle > 0 && angle < std::numbers::pi, "a corner turns by less than half a turn");
  const double clothoid = clothoid_length(angle), arc = arc_length(angle);
  const LinearCurvature rise({}, clothoid, 0, 1 / clothoid);
  const Pose middle = LinearCurvature(rise.at(clothoid).pose, 0.5 * arc, 1).at(0.5 * arc).pose;
  const double half = 0.5 * angle;
  return {angle_rad, middle.x_m + middle.y_m * std::tan(half), middle.y_m / std::cos(half),
          2 * clothoid + arc};
}

std::vector<CurveSegment> blend_segments(const Point2& corner_m, double heading_in_rad,
                                         const BlendShape& shape, double radius_m) {
  const double angle = std::abs(shape.angle_rad), sign = shape.angle_rad < 0 ? -1 : 1;
  const double clothoid_m = radius_m * clothoid_length(angle), arc_m = radius_m * arc_length(angle);
  const double peak = sign / radius_m, slope = peak / clothoid_m, back_m = radius_m * shape.tangent;
  const Pose begin{corner_m[0] - back_m * std::cos(heading_in_rad),
                   corner_m[1] - back_m * std::sin(heading_in_rad), heading_in_rad};
  const LinearCurvature rise(begin, clothoid_m, 0, slope);
  const LinearCurvature arc(rise.at(clothoid_m).pose, arc_m, peak);
  const LinearCurvature fall(arc.at(arc_m).pose, clothoid_m, peak, -slope);
  return {rise, arc, fall};
}

double corner_angle_rad(const std::vector<Point2>& polyline_m, std::size_t i) {
  if (i == 0 || i + 1 >= polyline_m.size()) return 0;
  return wrapped_angle_rad(bearing_rad(polyline_m[i], polyline_m[i + 1]) -
                           bearing_rad(polyline_m[i - 1], polyline_m[i]));
}

Path blended_polyline(const std::vector<Point2>& polyline_m, const std::vector<double>& radius_m) {
  constexpr double kNoStraight_m = 1e-9;  // blends that touch
  Path path;
  std::vector<CurveSegment> open;
  const auto close = [&] {
    if (!open.empty()) path.pieces.push_back(Curve(std::move(open)));
    open.clear();
  };
  double from_m = 0;  // where the straight part of the line begins
  for (std::size_t i = 0; i + 1 < polyline_m.size(); ++i) {
    const Point2 &here = polyline_m[i], &next = polyline_m[i + 1];
    const double h = bearing_rad(here, next), angle = corner_angle_rad(polyline_m, i + 1);
    const bool corner = std::abs(angle) > kNoCorner_rad, blended = corner && radius_m[i + 1] > 0;
    const BlendShape shape = blended ? blend_shape(angle) : BlendShape{};
    const double back_m = radius_m[i + 1] * shape.tangent;
    const double straight_m = std::hypot(next[0] - here[0], next[1] - here[1]) - from_m - back_m;
    if (straight_m > kNoStraight_m)
      open.push_back(
          LinearCurvature({here[0] + from_m * std::cos(h), here[1] + from_m * std::sin(h), h}, straight_m));
    from_m = back_m;
    if (blended) {
      for (CurveSegment& segment : blend_segments(next, h, shape, radius_m[i + 1]))
        open.push_back(std::move(segment));
    } else if (corner) {
      close();
      append_turn_to(path, {}, bearing_rad(next, polyline_m[i + 2]));
    }
  }
  close();
  return path;
}

}  // namespace joulepath
