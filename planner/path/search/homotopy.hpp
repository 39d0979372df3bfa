#pragma once

#include <vector>

#include "planner/path/floor/free_space.hpp"

// Method: [Bhattacharya2010]
namespace joulepath {

/// One point inside each island: a connected part of the floor that the disc cannot enter and that does not
/// touch the border of the map. Ways that pass an island on different sides are homotopically different.
[[nodiscard]] std::vector<Point2> island_points(const FreeSpace& space);

/// True if two polylines with the same ends are homotopic: the loop of one and the reversed other has winding
/// number 0 about every island.
[[nodiscard]] bool same_homotopy_class(const std::vector<Point2>& a_m, const std::vector<Point2>& b_m,
                                       const std::vector<Point2>& islands_m);

}  // namespace joulepath
