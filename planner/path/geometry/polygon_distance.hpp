#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace joulepath {

using Point2 = std::array<double, 2>;

[[nodiscard]] inline double distance_m(const Point2& a, const Point2& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1]);
}
/// Heading of the straight line from a to b.
[[nodiscard]] inline double bearing_rad(const Point2& a, const Point2& b) {
  return std::atan2(b[1] - a[1], b[0] - a[0]);
}

/// Distance from a point to a polygon's outline, negative inside (even-odd rule; any simple polygon).
[[nodiscard]] double signed_distance_m(const std::vector<Point2>& polygon_m, const Point2& point_m);

/// Distance between a polygon and the axis-aligned square |x - cx| <= h, |y - cy| <= h; 0 if they touch, less
/// than 0 if they overlap.
[[nodiscard]] double square_distance_m(const std::vector<Point2>& polygon_m, const Point2& center_m,
                                       double half_side_m);

}  // namespace joulepath
