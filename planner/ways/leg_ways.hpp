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
  std::size_t route{};  ///< index into the leg's pool; the route graph's comes after it
  bool wide{};          ///< over the route's merged corners
  bool stops_at_corners{};
  bool bends_at_ends{};  ///< leaves or reaches a stop along a given heading, on a lead
  Path path{};
  SmoothPath shape{};   ///< the shape behind the path: first guess of the control points
  double leaves_rad{};  ///< heading at the path's start
  double arrives_rad{};
  PathScore score{};
};

/// A leg between two places with its routes; the ways along them are made and scored at a price.
struct LegRoutes {
  RouteRequest request{};  ///< headings at the ends are not looked at
  std::vector<PooledRoute> routes{};
};

/// Index of the route with the shortest polyline.
[[nodiscard]] std::size_t shortest_route(const LegRoutes& routes);

/// What natural_ways() makes.
struct Variety {
  bool stop_turn_go{true};
  bool blends{true};                   ///< the largest that are free
  bool radii{true};                    ///< and smaller ones
  std::optional<std::size_t> route{};  ///< along this one alone
};

/// Ways that go straight from stop to stop in the headings that the routes have there: of each route the
/// largest blends that are free; of the best kVariedRoutes also stop-turn-go and blends of several radii.
/// All pass the collision check. Sorted by cost.
[[nodiscard]] std::vector<Way> natural_ways(const LegRoutes& routes, const LegRequest& leg,
                                            std::size_t leg_index, const ChoiceContext& context,
                                            const Variety& variety);

/// Ways that leave the start in one of the headings, reach the goal in one, or both, along the routes of the
/// best natural ways.
[[nodiscard]] std::vector<Way> bent_ways(const std::vector<Way>& natural,
                                         const std::vector<double>& start_rad,
                                         const std::vector<double>& goal_rad, const LegRequest& leg,
                                         std::size_t leg_index, const ChoiceContext& context);

}  // namespace joulepath
