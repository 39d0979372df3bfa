#include "planner/ways/leg_ways.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "planner/path/search/polyline.hpp"

namespace joulepath {
namespace {

constexpr double kBlendRadii_m[] = {0.3, 0.6, 1.0};
constexpr double kLeads_m[] = {0.4, 0.8, 1.5};
constexpr std::size_t kVariedRoutes = 2;
constexpr std::size_t kBentRoutes = 2;
constexpr double kAlong_rad = 0.03;  ///< headings this close need no lead
/// Shaping uses a clearance larger by this margin than the final check, so that rounding cannot fail the
/// check.
constexpr double kShapeMargin_m = 0.001;

std::string radius_name(double radius_m) {
  char text[32];
  std::snprintf(text, sizeof text, "blend_%.1f_m", radius_m);
  return text;
}

/// Creates and scores ways of one leg.
class WayMaker {
 public:
  WayMaker(const LegRequest& leg, std::size_t leg_index, const ChoiceContext& context)
      : leg_(leg),
        leg_index_(leg_index),
        context_(context),
        careful_(context.space->checker().with_clearance(context.space->checker().clearance_m() +
                                                         kShapeMargin_m)) {}

  double cost_J(const Way& way) const { return way.score.cost_J(context_.finite_price_W()); }

  std::optional<Way> natural(const PooledRoute& route, std::size_t index, bool wide,
                             const CornerPolicy& policy, const std::string& corners) const {
    Way way{.name = "route_" + std::to_string(index) + (wide ? "_wide_" : "_") + corners,
            .route = index,
            .wide = wide,
            .stops_at_corners = policy.kind == CornerPolicy::Kind::stop_turn_go,
            .shape = blend_corners(wide ? route.wide_m : route.polyline_m, careful_, policy)};
    if (context_.space->checker().first_collision(way.shape.path)) return std::nullopt;
    return scored(std::move(way));
  }

  /// Without a check and a score.
  Way blocked(const PooledRoute& route, std::size_t index) const {
    Way way{.name = "route_" + std::to_string(index) + "_blocked",
            .route = index,
            .stops_at_corners = true,
            .shape = blend_corners(route.polyline_m, careful_, {.kind = CornerPolicy::Kind::stop_turn_go})};
    take_path(way);
    return way;
  }

  std::optional<Way> bent(const Way& natural, const std::optional<Lead>& start,
                          const std::optional<Lead>& goal) const {
    auto shape = blend_with_leads(natural.shape.polyline_m, start, goal, careful_, {});
    if (!shape) return std::nullopt;
    Way way{.name = "route_" + std::to_string(natural.route) + (start ? "_leaving_along" : "") +
                    (goal ? "_arriving_along" : ""),
            .route = natural.route,
            .bends_at_ends = true,
            .shape = std::move(*shape)};
    return scored(std::move(way));
  }

 private:
  static void take_path(Way& way) {
    way.path = way.shape.path;
    way.leaves_rad = way.path.start().heading_rad;
    way.arrives_rad = way.path.end().heading_rad;
  }

  std::optional<Way> scored(Way way) const {
    take_path(way);
    way.score = score_path(way.path, leg_, leg_index_, context_);
    if (!way.score.drivable) return std::nullopt;
    return way;
  }

  const LegRequest& leg_;
  std::size_t leg_index_;
  const ChoiceContext& context_;
  FootprintChecker careful_;
};

void sort_by_cost(std::vector<Way>& ways, const WayMaker& maker) {
  std::stable_sort(ways.begin(), ways.end(),
                   [&](const Way& a, const Way& b) { return maker.cost_J(a) < maker.cost_J(b); });
}

bool differ(double a_rad, double b_rad) { return std::abs(wrapped_angle_rad(a_rad - b_rad)) > kAlong_rad; }

/// The cheapest lead length for a heading at one end.
std::optional<Way> best_lead(const WayMaker& maker, const Way& natural, bool at_start, double heading_rad,
                             std::optional<Lead>& lead) {
  std::optional<Way> best;
  for (const double length_m : kLeads_m) {
    const Lead tried{heading_rad, length_m};
    auto way = at_start ? maker.bent(natural, tried, std::nullopt) : maker.bent(natural, std::nullopt, tried);
    if (!way || (best && maker.cost_J(*best) <= maker.cost_J(*way))) continue;
    best = std::move(way);
    lead = tried;
  }
  return best;
}

void add_bent(const WayMaker& maker, const Way& natural, const std::vector<double>& start_rad,
              const std::vector<double>& goal_rad, std::vector<Way>& ways) {
  std::vector<Lead> starts, goals;
  const auto single = [&](bool at_start, double heading_rad, std::vector<Lead>& leads) {
    if (!differ(heading_rad, at_start ? natural.leaves_rad : natural.arrives_rad)) return;
    std::optional<Lead> lead;
    if (auto way = best_lead(maker, natural, at_start, heading_rad, lead)) {
      ways.push_back(std::move(*way));
      leads.push_back(*lead);
    }
  };
  for (const double heading_rad : start_rad) single(true, heading_rad, starts);
  for (const double heading_rad : goal_rad) single(false, heading_rad, goals);
  for (const Lead& start : starts)
    for (const Lead& goal : goals)
      if (auto way = maker.bent(natural, start, goal)) ways.push_back(std::move(*way));
}

}  // namespace

std::size_t shortest_route(const LegRoutes& routes) {
  const auto shortest = std::min_element(
      routes.routes.begin(), routes.routes.end(), [](const PooledRoute& a, const PooledRoute& b) {
        return polyline_length_m(a.polyline_m) < polyline_length_m(b.polyline_m);
      });
  return static_cast<std::size_t>(shortest - routes.routes.begin());
}

std::vector<Way> natural_ways(const LegRoutes& routes, const LegRequest& leg, std::size_t leg_index,
                              const ChoiceContext& context, const Variety& variety) {
  const WayMaker maker(leg, leg_index, context);
  std::vector<Way> ways;
  const auto wanted = [&](std::size_t index) { return !variety.route || *variety.route == index; };
  const auto add = [&](std::size_t index, bool wide, const CornerPolicy& policy, const std::string& corners) {
    if (auto way = maker.natural(routes.routes[index], index, wide, policy, corners))
      ways.push_back(std::move(*way));
  };
  for (std::size_t k = 0; k < routes.routes.size(); ++k) {
    if (!wanted(k) || !(variety.blends || routes.routes[k].polyline_m.size() < 3)) continue;
    add(k, false, {}, "largest_blend");
    if (!routes.routes[k].wide_m.empty()) add(k, true, {}, "largest_blend");
  }
  sort_by_cost(ways, maker);
  // The shortest route is the reference of the first step.
  std::vector<std::size_t> varied{shortest_route(routes)};
  for (const Way& way : ways)
    if (varied.size() < kVariedRoutes && way.route != varied.front()) varied.push_back(way.route);
  if (!variety.blends)
    for (std::size_t k = 0; k < routes.routes.size(); ++k)
      if (k != varied.front()) varied.push_back(k);
  for (const std::size_t index : varied) {
    if (!wanted(index) || routes.routes[index].polyline_m.size() < 3) continue;
    if (variety.stop_turn_go) add(index, false, {.kind = CornerPolicy::Kind::stop_turn_go}, "stop_turn_go");
    if (!variety.radii) continue;
    for (const double radius_m : kBlendRadii_m)
      add(index, false, {.kind = CornerPolicy::Kind::blend_radius, .radius_m = radius_m},
          radius_name(radius_m));
  }
  sort_by_cost(ways, maker);
  return ways;
}

Way blocked_way(const LegRoutes& routes, const LegRequest& leg, std::size_t leg_index,
                const ChoiceContext& context) {
  const std::size_t route = shortest_route(routes);
  return WayMaker(leg, leg_index, context).blocked(routes.routes[route], route);
}

std::vector<Way> bent_ways(const std::vector<Way>& natural, const std::vector<double>& start_rad,
                           const std::vector<double>& goal_rad, const LegRequest& leg, std::size_t leg_index,
                           const ChoiceContext& context) {
  const WayMaker maker(leg, leg_index, context);
  std::vector<Way> ways;
  std::vector<std::size_t> seen;
  for (const Way& way : natural) {
    if (seen.size() == kBentRoutes) break;
    if (std::find(seen.begin(), seen.end(), way.route) != seen.end()) continue;
    seen.push_back(way.route);
    add_bent(maker, way, start_rad, goal_rad, ways);
  }
  return ways;
}

}  // namespace joulepath
