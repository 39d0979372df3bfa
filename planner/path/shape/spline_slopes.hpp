#pragma once

#include "planner/path/geometry/path_slopes.hpp"
#include "planner/path/shape/free_spline.hpp"

namespace joulepath {

/// Derivatives of a cost by the variables of a FreeSpline.
struct SplineSlopes {
  std::vector<Point2> by_point_m{};
  double by_start_heading_rad{};
  double by_start_handle_m{};
  double by_goal_heading_rad{};
  double by_goal_handle_m{};
};

/// The chain rule from the derivatives by a path to those by the spline that it was made from. Places are
/// fixed parameters of the spans.
[[nodiscard]] SplineSlopes spline_slopes(const FreeSpline& spline, const Curve& curve,
                                         const PathSlopes& slopes);

/// One place of a span instead: derivatives by its pose and curvature.
struct PointSlope {
  std::size_t span{};
  double t{};
  double by_x_m{}, by_y_m{}, by_heading_rad{};
  double by_curvature{};
};
[[nodiscard]] SplineSlopes spline_slopes(const FreeSpline& spline, const PointSlope& slope);

}  // namespace joulepath
