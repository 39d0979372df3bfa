#pragma once

#include <string>
#include <vector>

#include "planner/path/search/route_pool.hpp"
#include "planner/path/shape/blended_path.hpp"
#include "planner/path/shape/end_leads.hpp"
#include "planner/ways/way_score.hpp"

namespace joulepath {

/// One way between two stops, without turns in place at its ends.
struct Way {
  std::string name{};
  std::size_t route{};  ///< index into the leg's pool; the route graph's route comes after the pool
  bool wide{};          ///< follows the route with merged corners
  bool stops_at_corners{};
  bool bends_at_ends{};  ///< leaves or reaches a stop along a given heading, on a lead
  Path path{};
  SmoothPath shape{};   ///< shape that the path was made from: first guess of the control points
  double leaves_rad{};  ///< heading at the path's start
  double arrives_rad{};
  PathScore score{};
};

/// A leg between two places with its routes; ways along them are created and scored at a price.
struct LegRoutes {
  RouteRequest request{};  ///< headings at the ends are ignored
  std::vector<PooledRoute> routes{};
};

/// Index of the route with the shortest polyline.
[[nodiscard]] std::size_t shortest_route(const LegRoutes& routes);

/// Options of natural_ways().
struct Variety {
  bool stop_turn_go{true};
  bool blends{true};                   ///< the largest free blends
  bool radii{true};                    ///< smaller blends as well
  std::optional<std::size_t> route{};  ///< along this route only
};

/// Ways that leave and reach the stops in the headings of the route: along each route with the largest free
/// blends; along the best kVariedRoutes also with stop-turn-go and with blends of several radii. All pass the
/// collision check. Sorted by cost.
[[nodiscard]] std::vector<Way> natural_ways(const LegRoutes& routes, const LegRequest& leg,
                                            std::size_t leg_index, const ChoiceContext& context,
                                            const Variety& variety);

/// The shortest route with a stop at every corner, whatever the outline meets there when it drives forward.
/// Not drivable: a place to begin for what drives backward. There must be a route.
[[nodiscard]] Way blocked_way(const LegRoutes& routes, const LegRequest& leg, std::size_t leg_index,
                              const ChoiceContext& context);

/// Ways that leave the start in one of the given headings, reach the goal in one, or both, along the routes
/// of the best natural ways.
[[nodiscard]] std::vector<Way> bent_ways(const std::vector<Way>& natural,
                                         const std::vector<double>& start_rad,
                                         const std::vector<double>& goal_rad, const LegRequest& leg,
                                         std::size_t leg_index, const ChoiceContext& context);

}  // namespace joulepath
