#pragma once

#include <vector>

#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// Proportions of a corner's blend, all lengths in units of its smallest radius (1 / peak curvature).
///
/// The blend is clothoid, circle arc, clothoid, symmetric about the corner's bisector: curvature rises
/// linearly from 0 to its peak, holds, and falls back to 0, so it joins straight lines with continuous
/// curvature. Each clothoid turns by `kClothoidShare` of the corner's angle.
struct BlendShape {
  static constexpr double kClothoidShare = 0.35;

  double angle_rad{};  ///< signed turn of the corner
  double tangent{};    ///< from the corner back to where the blend begins, and on to where it ends
  double deviation{};  ///< from the corner to the blend's middle
  double length{};     ///< arc length
};

/// Requires 0 < |angle_rad| < pi.
[[nodiscard]] BlendShape blend_shape(double angle_rad);

/// The blend's segments around a corner that is reached with a heading.
[[nodiscard]] std::vector<CurveSegment> blend_segments(const Point2& corner_m, double heading_in_rad,
                                                       const BlendShape& shape, double radius_m);

/// A smaller turn does not count as a corner.
inline constexpr double kNoCorner_rad = 1e-9;
/// A corner with a larger turn is too sharp for a blend.
inline constexpr double kSharpestBlend_rad = 2.7;

/// A blend has at least this radius: shorter arcs are turns in place.
inline constexpr double kLeastCornerRadius_m = 0.01;

/// Turn of a polyline at its point i, 0 at its ends.
[[nodiscard]] double corner_angle_rad(const std::vector<Point2>& polyline_m, std::size_t i);

/// The polyline with a blend of smallest radius radius_m[i] at point i; 0: a turn in place there. The blends
/// must fit between each other.
[[nodiscard]] Path blended_polyline(const std::vector<Point2>& polyline_m,
                                    const std::vector<double>& radius_m);

}  // namespace joulepath
