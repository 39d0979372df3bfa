#pragma once

#include <string>
#include <vector>

#include "planner/path/search/route.hpp"

namespace joulepath {

/// One route, as a taut polyline.
struct PooledRoute {
  std::vector<Point2> polyline_m{};
  std::vector<Point2> wide_m{};  ///< with merged corners, for wider blends; empty where none can be merged
  double cost{};                 ///< of travel and corners
  std::string searched_by{};
  unsigned search_iterations{};  ///< of all OMPL searches together
};

struct PoolOptions {
  int classes{4};   ///< homotopy classes kept
  int searches{1};  ///< OMPL searches, each with a seed of its own, and as many more where the cost of a
                    ///< metre differs over the floor; 0: only the lattice
  double dearest_ratio{1.35};  ///< greatest ratio of the cost of a route to that of the cheapest
};

/// Homotopically different routes in the order of their cost: for each class the cheapest that any source
/// found. Sources are a search of the map's cells, OMPL searches, a coarse lattice, and the lattice with a
/// higher price near earlier routes. Routes that pass every island on the same sides are one class. Where the
/// goal is in line of sight and the floor is uniform, the result is the straight line. Empty where no source
/// finds a way. Requires that no_way() is absent and that the goal differs from the start. Deterministic in
/// the request.
[[nodiscard]] std::vector<PooledRoute> pool_routes(const RouteSpace& space, const RouteRequest& request,
                                                   const PoolOptions& options);

/// Sum of the angles (rad) at the corners of a polyline.
[[nodiscard]] double corner_angles_rad(const std::vector<Point2>& polyline_m);

}  // namespace joulepath
