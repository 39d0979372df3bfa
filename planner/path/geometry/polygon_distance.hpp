#pragma once

#include <array>
#include <vector>

namespace joulepath {

using Point2 = std::array<double, 2>;

/// Distance from a point to a polygon's outline, negative inside (even-odd rule; any simple polygon).
[[nodiscard]] double signed_distance_m(const std::vector<Point2>& polygon_m, const Point2& point_m);

/// Distance between a polygon and the axis-aligned square |x - cx| <= h, |y - cy| <= h; 0 where they touch
/// and less than 0 where they overlap.
[[nodiscard]] double square_distance_m(const std::vector<Point2>& polygon_m, const Point2& center_m,
                                       double half_side_m);

}  // namespace joulepath
