#pragma once

#include <functional>
#include <vector>

#include "planner/path/search/search.hpp"

namespace joulepath {

/// Points this close are one.
inline constexpr double kSamePlace_m = 1e-6;

/// Whether the robot may drive straight between two points.
using LineFree = std::function<bool(const Point2& from_m, const Point2& to_m)>;

/// Pulls a polyline taut: skips vertices in line of sight, then moves each vertex towards its neighbors'
/// line as far as the line of sight allows, as long as the cost falls. The ends stay.
[[nodiscard]] std::vector<Point2> pull_taut(std::vector<Point2> polyline_m, const LineFree& free,
                                            const TravelCost& cost);

/// Makes one corner of two neighboring ones that turn the same way, where their outer lines meet in free
/// floor, the two are within `within_m` of each other and the way gets at most `extra_m` longer: one corner
/// has room for a wider blend.
[[nodiscard]] std::vector<Point2> merged_corners(std::vector<Point2> polyline_m, const LineFree& free,
                                                 double within_m, double extra_m);

[[nodiscard]] double polyline_length_m(const std::vector<Point2>& polyline_m);

}  // namespace joulepath
