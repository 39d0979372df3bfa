#pragma once

#include <string>
#include <vector>

#include "planner/path/search/route.hpp"

namespace joulepath {

/// One way to go, as a taut polyline.
struct PooledRoute {
  std::vector<Point2> polyline_m{};
  std::vector<Point2> wide_m{};  ///< with corners merged, for wider blends; empty where none can be
  double cost{};                 ///< of travel and corners
  std::string searched_by{};
  unsigned search_iterations{};  ///< of all OMPL searches together
};

struct PoolOptions {
  int classes{4};              ///< homotopy classes kept
  int searches{2};             ///< with OMPL, each with a seed of its own; 0: the lattice alone
  double dearest_ratio{1.35};  ///< of the cost of a route to that of the cheapest
};

/// Homotopically different routes, cheapest first, of each class the cheapest that any source found: OMPL
/// searches from several seeds, a coarse lattice, and the lattice with the neighborhood of earlier routes
/// made dear. Routes that pass every island on the same sides are one class. Where the goal is in sight and
/// the floor is alike everywhere, the straight line alone. Empty where no source finds a way.
/// Requires that no_way() has no objection and that the goal is not the start. Deterministic in the request.
[[nodiscard]] std::vector<PooledRoute> pool_routes(const RouteSpace& space, const RouteRequest& request,
                                                   const PoolOptions& options);

/// Sum of the angles (rad) at the corners of a polyline.
[[nodiscard]] double corner_angles_rad(const std::vector<Point2>& polyline_m);

}  // namespace joulepath
