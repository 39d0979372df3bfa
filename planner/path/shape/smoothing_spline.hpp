#pragma once

#include <cstddef>
#include <vector>

#include "model/prescribed_motion.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// A cubic spline near many points.
struct SmoothingSpline {
  std::vector<BezierPoints> curves_m{};  ///< its spans; curvature is continuous where they meet
  double deviation_m{};                  ///< largest distance of a point from the spline
  std::size_t worst{};                   ///< that point
};

/// A cubic spline with continuous curvature that begins at the first of some points, ends at the last and
/// comes within `tolerance_m` of all others. The number of its spans depends on the shape and the length, not
/// on the number of points.
///
/// Weighted least squares over a cubic B-spline by chord length u, with a weak penalty of the third
/// derivative that settles what the points leave open ([Dierckx1993], chapters 4 and 5):
///
///   min sum_i w_i |x(u_i) - p_i|^2 + sum_j (r h_j)^6 int_j |x'''|^2 du,   w_i = du there, h_j = length of
///   span j.
///
/// A span is halved, at a point, while it misses the tolerance, or while it is longer than 0.5 m and misses a
/// tenth of the tolerance with correlated residuals of neighboring points: that is shape, not noise.
/// `deviation_m` is above the tolerance only if no spline through every point exists. Requires two points or
/// more; neighbors must differ.
///
/// `directions`: empty, or the unit vector of the motion at each point. Then the squares of dx/du less the
/// direction, times 1 m^2, join the sum, a span is also halved while its direction is more than 0.3 mrad off
/// with correlated residuals, and the spline has the first and the last direction exactly.
[[nodiscard]] SmoothingSpline smoothing_spline(const std::vector<Point2>& points_m, double tolerance_m,
                                               const std::vector<Point2>& directions = {});

}  // namespace joulepath
