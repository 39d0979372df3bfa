#include "planner/path/shape/blended_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "planner/path/shape/corner_blend.hpp"

namespace joulepath {
namespace {

constexpr double kLadderRatio = 0.75;
constexpr double kSmallestRadius_m = 0.03;
constexpr double kShortestStraight_m = 0.01;  // minimum length of the straight line between blends
constexpr std::array<double, 3> kOutwardShares{0.0, 0.5, 1.0};

/// A polyline with blends at its inner vertices: the state of the search over radii.
class BlendedPolyline {
 public:
  BlendedPolyline(const std::vector<Point2>& polyline_m, const FootprintChecker& checker)
      : original_(polyline_m), points_(polyline_m), radius_m_(polyline_m.size(), 0.0), checker_(checker) {}

  std::size_t size() const { return points_.size(); }
  double angle_rad(std::size_t i) const { return corner_angle_rad(points_, i); }
  double radius_m(std::size_t i) const { return radius_m_[i]; }
  const std::vector<Point2>& points_m() const { return points_; }
  const std::vector<double>& radii_m() const { return radius_m_; }
  const Point2& point_m(std::size_t i) const { return points_[i]; }

  /// Gives corner i a radius if that is free; moves the vertex outwards as little as needed. The blend may
  /// use a share of the lines to the neighboring corners.
  bool try_radius(std::size_t i, double radius_m, double share_of_line);

  std::vector<CurveSegment> blend(std::size_t i) const {
    return blend_segments(points_[i], bearing_rad(points_[i - 1], points_[i]), blend_shape(angle_rad(i)),
                          radius_m_[i]);
  }
  double tangent_m(std::size_t i) const {
    return radius_m_[i] > 0 ? radius_m_[i] * blend_shape(angle_rad(i)).tangent : 0.0;
  }
  double straight_m(std::size_t i) const {  // between the blends of vertices i and i + 1
    return distance_m(points_[i], points_[i + 1]) - tangent_m(i) - tangent_m(i + 1);
  }

 private:
  bool within_share(std::size_t i, double share_of_line) const;
  bool fits_around(std::size_t i) const;
  bool free_around(std::size_t i) const;
  bool straight_free(std::size_t i) const;

  std::vector<Point2> original_;
  std::vector<Point2> points_;
  std::vector<double> radius_m_;
  const FootprintChecker& checker_;
};

bool BlendedPolyline::try_radius(std::size_t i, double radius_m, double share_of_line) {
  const Point2 old_point = points_[i];
  const double old_radius_m = radius_m_[i];
  for (const double outward : kOutwardShares) {
    points_[i] = original_[i];
    radius_m_[i] = radius_m;
    const double angle = angle_rad(i);
    if (std::abs(angle) > kNoCorner_rad && std::abs(angle) < kSharpestBlend_rad) {
      // The outside of the corner is along the bisector of the incoming and the reversed outgoing line.
      const double inward_rad = bearing_rad(points_[i - 1], points_[i]) + 0.5 * angle +
                                std::copysign(0.5 * std::numbers::pi, angle);
      const double out_m = outward * radius_m * blend_shape(angle).deviation;
      points_[i] = {original_[i][0] - out_m * std::cos(inward_rad),
                    original_[i][1] - out_m * std::sin(inward_rad)};
      if (within_share(i, share_of_line) && fits_around(i) && free_around(i)) return true;
    }
  }
  points_[i] = old_point;
  radius_m_[i] = old_radius_m;
  return false;
}

bool BlendedPolyline::within_share(std::size_t i, double share_of_line) const {
  const double tangent = tangent_m(i);
  const bool before = i == 1 || tangent <= share_of_line * distance_m(points_[i - 1], points_[i]);
  const bool after = i + 2 == size() || tangent <= share_of_line * distance_m(points_[i], points_[i + 1]);
  return before && after;
}

bool BlendedPolyline::fits_around(std::size_t i) const {
  const std::size_t first = i >= 2 ? i - 2 : 0, last = std::min(i + 1, size() - 2);
  for (std::size_t k = first + 1; k <= last; ++k) {
    const double angle = std::abs(angle_rad(k));
    if (radius_m_[k] > 0 && (angle <= kNoCorner_rad || angle >= kSharpestBlend_rad)) return false;
  }
  for (std::size_t k = first; k <= last; ++k)
    if (straight_m(k) < kShortestStraight_m) return false;
  return true;
}

bool BlendedPolyline::straight_free(std::size_t i) const {
  const double h = bearing_rad(points_[i], points_[i + 1]), from_m = tangent_m(i),
               to_m = from_m + straight_m(i);
  const double c = std::cos(h), s = std::sin(h);
  const Point2& p = points_[i];
  return checker_.line_free(p[0] + from_m * c, p[1] + from_m * s, p[0] + to_m * c, p[1] + to_m * s);
}

bool BlendedPolyline::free_around(std::size_t i) const {
  const std::size_t first = i >= 2 ? i - 2 : 0, last = std::min(i + 1, size() - 2);
  for (std::size_t k = first + 1; k <= last; ++k) {
    if (radius_m_[k] == 0) continue;
    for (const CurveSegment& segment : blend(k))
      if (!checker_.segment_free(segment)) return false;
  }
  for (std::size_t k = first; k <= last; ++k)
    if (!straight_free(k)) return false;
  return true;
}

void grow_blends(BlendedPolyline& line, double largest_m) {
  // First each corner may use half of the lines to its neighbors, then the remaining length as well.
  for (const double share : {0.5, 1.0})
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
      for (double radius_m = largest_m; radius_m > std::max(kSmallestRadius_m, line.radius_m(i));
           radius_m *= kLadderRatio)
        if (line.try_radius(i, radius_m, share)) break;
}

}  // namespace

SmoothPath blend_corners(const std::vector<Point2>& polyline_m, const FootprintChecker& checker,
                         const CornerPolicy& policy) {
  SmoothPath result;
  if (polyline_m.size() < 2) return result;
  BlendedPolyline line(polyline_m, checker);
  if (policy.kind == CornerPolicy::Kind::largest_blend) grow_blends(line, CornerPolicy::kLargestRadius_m);
  if (policy.kind == CornerPolicy::Kind::blend_radius) grow_blends(line, policy.radius_m);
  result.path = blended_polyline(line.points_m(), line.radii_m());
  result.polyline_m = polyline_m;
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
    result.corners.push_back({line.point_m(i)[0], line.point_m(i)[1], line.angle_rad(i), line.radius_m(i)});
  return result;
}

}  // namespace joulepath
