#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// Why no path leads along some waypoints.
struct WaypointDefect {
  std::size_t waypoint{};
  bool radius{};  ///< its radius is what is wrong, else its place
  std::string found{};
  std::string accepted{};
};

/// A path along waypoints, or why there is none.
struct WaypointPath {
  Path path{};
  std::optional<WaypointDefect> defect{};
};

inline constexpr double kWaypointTolerance_m = 0.01;

/// A curve with continuous curvature along waypoints (m), driven forward without a stop: the natural cubic
/// spline through them by chord length, or, where they are dense, a smoothing spline within `tolerance_m` of
/// each (0: always through them). Dense are more than 1000 waypoints, and neighbors closer than 8 tolerances
/// on average: a slip by the tolerance at one would bend the curve through it to a radius below 8 tolerances.
///
/// Where the waypoints lead straight back, the robot stops and turns in place between two splines. Two
/// waypoints or more, neighbors at different places; dense ones may repeat a place (a robot that stood).
[[nodiscard]] WaypointPath curve_through(const std::vector<Point2>& waypoints_m,
                                         double tolerance_m = kWaypointTolerance_m);

/// Straight lines from waypoint to waypoint. Corner i is rounded by a blend (see blended_polyline) of
/// smallest radius radius_m[i]; 0: the robot stops and turns there. The ends' radii are not looked at.
[[nodiscard]] WaypointPath lines_between(const std::vector<Point2>& waypoints_m,
                                         const std::vector<double>& radius_m);

}  // namespace joulepath
