#include "planner/leg_choice.hpp"

#include <algorithm>
#include <cmath>

#include "planner/path/candidates.hpp"
#include "planner/path/graph_route.hpp"

namespace joulepath {
namespace {

constexpr int kRoutes = 3;
constexpr double kBlendRadii_m[] = {0.3, 0.6, 1.0};
constexpr std::size_t kScoringNodes = 60;  ///< ways differ by percents, grids by hundredths of them
constexpr double kScoringAccuracy = 1e-2;

std::string radius_name(double radius_m) {
  char text[32];
  std::snprintf(text, sizeof text, "blend_%.1f_m", radius_m);
  return text;
}

/// The ways round the corners of one route.
void add_corner_variants(const RouteResult& route, const RouteRequest& request, const RouteSpace& space,
                         const std::string& prefix, std::vector<LegWays::Way>& candidates) {
  candidates.push_back({prefix + "largest_blend", route.path});
  if (route.corners.empty()) return;
  const auto add = [&](const std::string& name, const CornerPolicy& policy) {
    RouteRequest variant = request;
    variant.corners = policy;
    RouteResult shaped = shape_route(space, variant, route.polyline_m);
    if (shaped.found()) candidates.push_back({prefix + name, std::move(shaped.path)});
  };
  add("stop_turn_go", {.kind = CornerPolicy::Kind::stop_turn_go});
  for (double radius_m : kBlendRadii_m)
    add(radius_name(radius_m), {.kind = CornerPolicy::Kind::blend_radius, .radius_m = radius_m});
}

/// Steady power (W, standby included) of driving straight along `heading_rad` at a point.
double steady_power_W(const Plant& plant, double payload_kg, double speed_m_s, const Pose& pose) {
  const Site site = site_of(plant.robot.geometry, pose, payload_kg, speed_m_s, 0.0);
  return std::max(0.0, power_by_cause(plant, {.speed_m_s = speed_m_s}, site).total_W());
}

}  // namespace

PathScore score_path(const Path& path, const LegRequest& leg, std::size_t leg_index,
                     const ChoiceContext& context) {
  PlanOptions options = context.options;
  options.nodes = std::min(options.nodes, kScoringNodes);
  options.accuracy = std::max(options.accuracy, kScoringAccuracy);
  LegTiming timing(
      stretches_of(path, leg, leg_index, context.mission, context.world, context.plant, options));
  const std::vector<ProfileResult>& results = timing.solve(context.price_W, SolverChoice::fast);
  PathScore score{.drivable = true};
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (!results[k].profile) return {};
    score.energy_J += energy_by_cause(path_motion(timing.stretches()[k]), *results[k].profile).total_J();
    score.duration_s += results[k].profile->duration_s();
  }
  return score;
}

TravelCost energy_rate(const LegRequest& leg, const ChoiceContext& context) {
  const Plant& plant = context.plant;
  const double payload_kg = std::max(leg.payload.from_kg, leg.payload.to_kg);
  const double limit_m_s = limits_along(context.world.robot, leg.payload).speed_m_s;
  const double cruise_m_s = std::isfinite(limit_m_s) ? limit_m_s : 1.0;
  const std::optional<SpeedMask>& mask = context.world.speed_mask;
  const double price_W = std::isfinite(context.price_W) ? context.price_W : 1e3;
  const auto rate = [&plant, &mask, payload_kg, cruise_m_s, price_W](double x_m, double y_m,
                                                                     double heading_rad) {
    double speed_m_s = cruise_m_s;
    if (mask)
      speed_m_s =
          std::min(speed_m_s, std::max(0.05, mask->speed_cap_m_s(x_m, y_m, cruise_m_s).value_or(cruise_m_s)));
    return (steady_power_W(plant, payload_kg, speed_m_s, {x_m, y_m, heading_rad}) + price_W) / speed_m_s;
  };
  // Nothing on the floor can be cheaper than the same robot without any effect, at full speed, downhill at
  // most.
  double least = rate(1e9, 1e9, 0.0);
  for (int k = 0; k < 16; ++k) least = std::min(least, rate(1e9, 1e9, 0.39269908169872414 * k));
  return {.rate = rate, .least_rate = std::max(1e-3, 0.999 * least)};
}

LegWays leg_ways(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                 const ChoiceContext& context) {
  LegWays found{.start = start};
  if (leg.path || !context.space) {
    found.settled = leg_path(leg, leg_index, start, context.mission, context.space, context.options);
    return found;
  }
  RouteRequest request = route_request(leg, leg_index, start, context.mission, context.options);
  const bool floor_matters = !context.plant.effects.empty() || context.world.speed_mask;
  if (floor_matters) request.cost = energy_rate(leg, context);
  const std::vector<RouteResult> routes = plan_candidates(*context.space, request, kRoutes);
  if (routes.empty() || !routes.front().found()) {
    found.settled = leg_path(leg, leg_index, start, context.mission, context.space, context.options);
    return found;
  }
  found.source = routes.front().searched_by;
  for (std::size_t k = 0; k < routes.size(); ++k)
    add_corner_variants(routes[k], request, *context.space, "route_" + std::to_string(k) + "_", found.ways);
  if (context.world.route_graph) {
    const RouteResult on_graph = plan_graph_route(*context.space, request, *context.world.route_graph);
    if (on_graph.found()) add_corner_variants(on_graph, request, *context.space, "graph_", found.ways);
  }
  return found;
}

LegPath choose_leg_path(const LegWays& ways, const LegRequest& leg, std::size_t leg_index,
                        const ChoiceContext& context) {
  if (ways.settled) return *ways.settled;
  LegPath chosen{.source = ways.source};
  std::size_t best = ways.ways.size();
  double least_J = kNoLimit;
  const double price_W = std::isfinite(context.price_W) ? context.price_W : 1e6;
  for (const LegWays::Way& way : ways.ways) {
    const PathScore score = score_path(way.path, leg, leg_index, context);
    const double cost_J = score.drivable ? score.cost_J(price_W) : kNoLimit;
    chosen.alternatives.push_back({.name = way.name,
                                   .energy_J = score.drivable ? score.energy_J : kNoLimit,
                                   .duration_s = score.drivable ? score.duration_s : kNoLimit,
                                   .distance_m = way.path.distance_m()});
    if (cost_J >= least_J) continue;
    least_J = cost_J;
    best = chosen.alternatives.size() - 1;
  }
  if (best == ways.ways.size()) best = 0;  // none can be driven: the first one says why
  chosen.path = ways.ways[best].path;
  chosen.alternatives[best].chosen = true;
  return chosen;
}

}  // namespace joulepath
