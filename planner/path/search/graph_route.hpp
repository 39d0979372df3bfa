#pragma once

#include <vector>

#include "planner/path/search/route.hpp"
#include "planner/path/search/route_graph.hpp"

namespace joulepath {

/// A way over a route graph instead of free space: the cheapest chain of directed edges from the node
/// nearest to the start that is in a free straight line from it, to the node nearest to the goal likewise.
/// The polyline keeps to the graph's lines; its corners are shaped as the request says. Edges that the
/// footprint cannot follow are not used. The verdict is `no_connection` where the graph has no way.
[[nodiscard]] RouteResult plan_graph_route(const RouteSpace& space, const RouteRequest& request,
                                           const RouteGraph& graph);

}  // namespace joulepath
