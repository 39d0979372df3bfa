#pragma once

#include <functional>
#include <vector>

#include "planner/path/search/search.hpp"

namespace joulepath {

/// Points within this distance count as equal.
inline constexpr double kSamePlace_m = 1e-6;

/// True if the robot may drive straight between two points.
using LineFree = std::function<bool(const Point2& from_m, const Point2& to_m)>;

/// Pulls a polyline taut: skips vertices in line of sight, then moves each vertex towards the line of its
/// neighbors as far as the line of sight allows and as long as the cost falls. The ends stay.
[[nodiscard]] std::vector<Point2> pull_taut(std::vector<Point2> polyline_m, const LineFree& free,
                                            const TravelCost& cost);

/// Merges two neighboring corners that turn the same way into one, which allows a wider blend. Requires that
/// their outer lines meet in free floor, that the corners are within `within_m` of each other, and that the
/// way grows by at most `extra_m`.
[[nodiscard]] std::vector<Point2> merged_corners(std::vector<Point2> polyline_m, const LineFree& free,
                                                 double within_m, double extra_m);

[[nodiscard]] double polyline_length_m(const std::vector<Point2>& polyline_m);

}  // namespace joulepath
