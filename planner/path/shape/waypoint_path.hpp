#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// The reason why there is no path along some waypoints.
struct WaypointDefect {
  std::size_t waypoint{};
  bool radius{};  ///< its radius is wrong, else its place
  std::string found{};
  std::string accepted{};
};

/// A path along waypoints, or the reason why there is none.
struct WaypointPath {
  Path path{};
  std::optional<WaypointDefect> defect{};
  bool exact{};  ///< along poses that a planner wrote (direction_fit)
};

inline constexpr double kWaypointTolerance_m = 0.01;

/// A curve with continuous curvature along waypoints (m), driven forward without a stop: the natural cubic
/// spline through them by chord length, or, if they are dense, a smoothing spline within `tolerance_m` of
/// each (0: always through them). Waypoints are dense if there are more than 1000, or if neighbors are closer
/// than 8 tolerances on average: an error of the tolerance at one would bend the curve through it to a radius
/// below 8 tolerances.
///
/// Where the waypoints reverse (within kRounding_rad), the robot stops and turns in place between two
/// splines. Requires two waypoints or more, neighbors at least kRounding_m apart; dense ones may be closer
/// and repeat a place (a robot that stood).
[[nodiscard]] WaypointPath curve_through(const std::vector<Point2>& waypoints_m,
                                         double tolerance_m = kWaypointTolerance_m);

/// Straight lines from waypoint to waypoint. Corner i is rounded by a blend (see blended_polyline) of
/// smallest radius radius_m[i], at least kLeastCornerRadius_m; 0: the robot stops and turns there, except
/// within kRounding_rad. Slight corners are rounded more widely, so that a path with waypoints nearly on a
/// line is nearly the path along the line. The ends' radii are ignored; waypoints must be kRounding_m apart.
[[nodiscard]] WaypointPath lines_between(const std::vector<Point2>& waypoints_m,
                                         const std::vector<double>& radius_m);

}  // namespace joulepath
