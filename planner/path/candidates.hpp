#pragma once

#include <vector>

#include "planner/path/homotopy.hpp"
#include "planner/path/route.hpp"

namespace joulepath {

/// Several homotopically different routes to the same goal, cheapest polyline first; the first is
/// plan_route's unless one found later is cheaper. Fewer than `count` when the floor has no more within
/// `longest_ratio` of the cheapest. Each later one comes from a search over a coarse lattice that makes the
/// neighborhood of earlier ones dear. Without any route: the one result that says why.
[[nodiscard]] std::vector<RouteResult> plan_candidates(const RouteSpace& space, const RouteRequest& request,
                                                       int count, double longest_ratio = 1.5);

}  // namespace joulepath
