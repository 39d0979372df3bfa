#pragma once

#include <optional>
#include <vector>

#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// A cubic spline with continuous first and second derivative through points, its tangents at both ends given
/// as heading and handle length: the first Bezier handle of the first span, the last of the last one.
/// Parameters of the spans are the chords between the points.
struct FreeSpline {
  std::vector<Point2> points_m{};  ///< start, knots, goal: at least two
  double start_heading_rad{};
  double start_handle_m{};
  double goal_heading_rad{};
  double goal_handle_m{};
};

/// The spans of the spline as cubic Bezier curves. Requires two points; neighbors must differ.
[[nodiscard]] std::vector<BezierPoints> spline_spans(const FreeSpline& spline);

/// The spline as a path of one piece; absent if points or handles coincide or if it bends more tightly than
/// kTightest_per_m anywhere: a cusp cannot be driven.
[[nodiscard]] std::optional<Path> free_spline_path(const FreeSpline& spline);

inline constexpr double kTightest_per_m = 25.0;

}  // namespace joulepath
