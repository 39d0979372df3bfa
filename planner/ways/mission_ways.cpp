#include "planner/ways/mission_ways.hpp"

#include "planner/legs/floor_check.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/path/search/graph_route.hpp"
// Design: docs/decisions/0004-ways-by-energy.md
namespace joulepath {

std::optional<LegRoutes> MissionWays::routes_of(std::size_t leg, const LegStart& start,
                                                double price_W) const {
  const LegRequest& asked = mission_.legs[leg];
  if (asked.path || asked.motion || !space_) return std::nullopt;
  LegRoutes routes{.request = route_request(asked, start, mission_, options_)};
  if (is_there_already(routes.request) || no_way(*space_, routes.request)) return std::nullopt;
  const ChoiceContext at_price = context(price_W);
  TurnScores turns(at_price);
  routes.request.cost = travel_cost(asked, at_price, turns);
  routes.routes = pool_routes(*space_, routes.request, {});
  if (world_.route_graph) {
    const RouteResult on_graph = plan_graph_route(*space_, routes.request, *world_.route_graph);
    if (on_graph.found())
      routes.routes.push_back({.polyline_m = on_graph.polyline_m,
                               .cost = on_graph.polyline_cost,
                               .searched_by = on_graph.searched_by});
  }
  if (routes.routes.empty()) return std::nullopt;
  return routes;
}

LegPath MissionWays::settled(std::size_t leg, const LegStart& start) const {
  const LegRequest& asked = mission_.legs[leg];
  if (!asked.motion) return leg_path(asked, leg, start, mission_, space_, options_);
  LegPath way{.source = "motion"};
  if (space_)
    way.infeasibility = blocked_motion(*prescribed_leg(asked, plant_, start.pose).prescribed, *space_);
  return way;
}

std::vector<LegPath> MissionWays::choose(const std::vector<double>& price_W, bool quick) const {
  std::vector<LegPath> paths;
  LegStart here{.pose = mission_.start.pose, .heading_free = !mission_.start.heading_given};
  while (paths.size() < mission_.legs.size()) {
    WayRun run{.first = paths.size(), .start = here, .quick = quick};
    LegStart there = here;
    for (std::size_t leg = paths.size(); leg < mission_.legs.size(); ++leg) {
      auto routes = routes_of(leg, there, price_W[leg]);
      if (!routes) break;
      run.contexts.push_back(context(price_W[leg]));
      run.routes.push_back(std::move(*routes));
      const Station& stop = mission_.stations.at(mission_.legs[leg].to);
      there = {{stop.x_m, stop.y_m, stop.heading_rad.value_or(0.0)}, !stop.heading_rad};
    }
    std::vector<LegPath> chosen = choose_run(run);
    if (chosen.empty()) chosen.push_back(settled(paths.size(), here));
    for (LegPath& path : chosen) {
      const std::size_t leg = paths.size();
      if (mission_.legs[leg].motion) {
        const Trajectory motion = *prescribed_leg(mission_.legs[leg], plant_, here.pose).prescribed;
        here.pose = sampled_state(motion, motion.time_s.back()).pose;
      } else if (!path.path.pieces.empty()) {
        here = {.pose = path.path.end(), .heading_free = false};
      }
      paths.push_back(std::move(path));
      if (paths.back().infeasibility) return paths;
    }
  }
  return paths;
}

}  // namespace joulepath
