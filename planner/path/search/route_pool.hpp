#pragma once

#include <array>
#include <optional>
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
  bool outline_fits{true};       ///< the outline can drive it by straight lines and turns in place
};

struct PoolOptions {
  int classes{4};   ///< homotopy classes kept
  int searches{1};  ///< OMPL searches, each with a seed of its own, and as many more where the cost of a
                    ///< metre differs over the floor; 0: only the lattice
  double dearest_ratio{1.35};  ///< greatest ratio of the cost of a route to that of the cheapest
};

/// Headings (rad) at the ends on which routes depend: absent where they are free, and for a disc.
using EndHeadings = std::array<std::optional<double>, 2>;
[[nodiscard]] EndHeadings end_headings(const RouteSpace& space, const RouteRequest& request);

/// Homotopically different routes in the order of their cost: for each class the cheapest that any source
/// found. Sources are a search of the map's cells, OMPL searches, a coarse lattice, and the lattice with a
/// higher price near earlier routes. Where an outline that is no disc cannot turn everywhere on the way, they
/// search for its inscribed disc, and a search over places and headings for the outline itself: of a class,
/// the cheapest route that the outline can drive so is kept beside the cheapest. Routes that pass every
/// island on the same sides are one class. Where the goal is in line of sight and the floor is uniform, the
/// result is the straight line. Empty where no source finds a way. Requires that no_way() is absent and that
/// the goal differs from the start. Deterministic in the request.
[[nodiscard]] std::vector<PooledRoute> pool_routes(const RouteSpace& space, const RouteRequest& request,
                                                   const PoolOptions& options);

/// Sum of the angles (rad) at the corners of a polyline.
[[nodiscard]] double corner_angles_rad(const std::vector<Point2>& polyline_m);

}  // namespace joulepath
