#include "planner/path/geometry/polygon_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace joulepath {
namespace {

double point_segment_squared(const Point2& p, const Point2& a, const Point2& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0.0;
  const double ex = px - t * dx, ey = py - t * dy;
  return ex * ex + ey * ey;
}

double point_box_squared(const Point2& p, double half) {
  const double x = std::max(0.0, std::abs(p[0]) - half), y = std::max(0.0, std::abs(p[1]) - half);
  return x * x + y * y;
}

/// Middle of the part of a segment within |x|, |y| <= half, by Liang and Barsky's clipping.
std::optional<Point2> middle_in_box(const Point2& a, const Point2& b, double half) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < 2; ++i) {
    const double d = b[i] - a[i];
    if (d == 0) {
      if (std::abs(a[i]) > half) return std::nullopt;
      continue;
    }
    const double t0 = (-half - a[i]) / d, t1 = (half - a[i]) / d;
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  if (from > to) return std::nullopt;
  const double t = 0.5 * (from + to);
  return Point2{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

}  // namespace

double signed_distance_m(const std::vector<Point2>& polygon_m, const Point2& p) {
  double best2 = std::numeric_limits<double>::infinity();
  bool inside = false;
  for (std::size_t i = 0, j = polygon_m.size() - 1; i < polygon_m.size(); j = i++) {
    const Point2 &a = polygon_m[i], &b = polygon_m[j];
    best2 = std::min(best2, point_segment_squared(p, a, b));
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
      inside = !inside;
  }
  return inside ? -std::sqrt(best2) : std::sqrt(best2);
}

double square_distance_m(const std::vector<Point2>& polygon_m, const Point2& center_m, double half_side_m) {
  const double center_distance_m = signed_distance_m(polygon_m, center_m);
  if (center_distance_m < 0) return center_distance_m;
  double best2 = std::numeric_limits<double>::infinity();
  std::optional<double> depth_m;
  const Point2 corners[] = {{-half_side_m, -half_side_m},
                            {half_side_m, -half_side_m},
                            {half_side_m, half_side_m},
                            {-half_side_m, half_side_m}};
  for (std::size_t i = 0, j = polygon_m.size() - 1; i < polygon_m.size(); j = i++) {
    const Point2 a{polygon_m[i][0] - center_m[0], polygon_m[i][1] - center_m[1]};
    const Point2 b{polygon_m[j][0] - center_m[0], polygon_m[j][1] - center_m[1]};
    if (const auto middle = middle_in_box(a, b, half_side_m)) {
      const double inside_m = half_side_m - std::max(std::abs((*middle)[0]), std::abs((*middle)[1]));
      depth_m = std::max(depth_m.value_or(0.0), inside_m);
    }
    if (depth_m) continue;
    best2 = std::min(best2, point_box_squared(a, half_side_m));
    for (const Point2& corner : corners) best2 = std::min(best2, point_segment_squared(corner, a, b));
  }
  return depth_m ? -*depth_m : std::sqrt(best2);
}

}  // namespace joulepath
