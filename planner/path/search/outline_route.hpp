#pragma once

#include <vector>

#include "planner/path/search/route.hpp"

namespace joulepath {

/// Whether the outline may drive a polyline by straight lines and turns in place, turns to the stated
/// headings at its ends included.
[[nodiscard]] bool outline_drives(const RouteSpace& space, const RouteRequest& request,
                                  const std::vector<Point2>& polyline_m);

/// The corners of a way that the whole outline can drive by straight lines and turns in place, where the
/// floor is too narrow for it to turn anywhere: A* over places in steps of a cell and 16 headings, then
/// pulled taut. Empty if there is none on those places.
[[nodiscard]] std::vector<Point2> outline_route(const RouteSpace& space, const RouteRequest& request);

}  // namespace joulepath
