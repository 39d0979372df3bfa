#pragma once

#include "planner/path/floor/obstacle_field.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// Lower bounds of the length of ways on a floor.
struct Geodesic {
  double length_m{};
  bool around_corners{};  ///< longer than the straight line
};

/// No way of a disc's center between two points is shorter: the length of the shortest way around polygons
/// that lie within the blocked cells widened by the disc. Its bends are at corners of these polygons, so the
/// search is A* on the visibility graph; lines that may be free count as free. `at_most_m`: the length of a
/// known way.
[[nodiscard]] Geodesic shortest_way(const ObstacleField& field, double radius_m, const Point2& start_m,
                                    const Point2& goal_m, double at_most_m);

}  // namespace joulepath
