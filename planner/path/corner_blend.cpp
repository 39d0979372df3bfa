#include "planner/path/corner_blend.hpp"

#include <cmath>
#include <numbers>

#include "model/assert.hpp"

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

}  // namespace joulepath
