#pragma once

#include <vector>

#include "planner/path/search/route.hpp"
#include "planner/path/search/route_graph.hpp"

namespace joulepath {

/// A way over a route graph instead of free space: the cheapest chain of directed edges from a node near the
/// start to a node near the goal, each connected to its end by a free straight line. The polyline follows the
/// lines of the graph; its corners are shaped as the request says. Edges that the footprint cannot follow are
/// not used. The verdict is `no_connection` where the graph has no way.
[[nodiscard]] RouteResult plan_graph_route(const RouteSpace& space, const RouteRequest& request,
                                           const RouteGraph& graph);

}  // namespace joulepath
