#include "planner/ways/mission_ways.hpp"

#include <algorithm>
#include <cmath>

#include "model/progress.hpp"
#include "model/workers.hpp"
#include "planner/legs/floor_check.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/path/search/graph_route.hpp"
#include "planner/values/leg_state.hpp"
#include "planner/ways/way_fields.hpp"
// Design: docs/decisions/0210-ways.md
namespace joulepath {
namespace {

constexpr int kMostRounds = 3;         ///< of closing what a way around meets
constexpr std::size_t kMostAlone = 4;  ///< dear parts that are closed each alone

LegQuestion question_of(const ChoiceContext& context, std::size_t leg) {
  const LegRequest& asked = context.mission.legs[leg];
  const Station& stop = context.mission.stations.at(asked.to);
  LegQuestion question{.payload = asked.payload,
                       .start_speed_m_s = asked.start_speed_m_s,
                       .end_speed_m_s = asked.end_speed_m_s,
                       .yaw_rate_rad_s = asked.yaw_rate_rad_s,
                       .price_W = context.price_W,
                       .goal_x_m = stop.x_m,
                       .goal_y_m = stop.y_m,
                       .goal_heading_rad = stop.heading_rad,
                       .direction = asked.direction};
  for (const SpeedZone& zone : context.mission.speed_zones)
    if (zone.leg == leg) question.zones.push_back({zone.from_m, zone.to_m, zone.speed_m_s});
  return question;
}

}  // namespace

bool MissionWays::has_choice(std::size_t leg, const LegStart& start) const {
  const LegRequest& asked = mission_.legs[leg];
  if (asked.path || asked.motion || !space_) return false;
  const RouteRequest request = route_request(asked, start, mission_, options_);
  return !is_there_already(request) && !no_way(*space_, request);
}

std::vector<MissionWays::Together> MissionWays::groups_from(std::size_t leg, LegStart start) const {
  std::vector<Together> groups;
  for (bool joined = false; leg < mission_.legs.size() && has_choice(leg, start); ++leg) {
    if (!joined) groups.push_back({.first = leg, .start = start});
    ++groups.back().count;
    const Station& stop = stop_of(leg);
    start = {{stop.x_m, stop.y_m, stop.heading_rad.value_or(0.0)}, !stop.heading_rad};
    joined = !stop.heading_rad;
  }
  return groups;
}

std::vector<PooledRoute> MissionWays::routes_of(std::size_t leg, const RouteRequest& request, double price_W,
                                                const RouteSpace& space) const {
  const LegQuestion question = question_of(context(price_W, &space), leg);
  const auto search = [&] { return pool_routes(space, request, {}); };
  std::vector<PooledRoute> routes =
      request.cost.rate ? search()
                        : remembered(options_.answers, "routes", search, request.start.x_m, request.start.y_m,
                                     request.goal_x_m, request.goal_y_m, end_headings(space, request),
                                     request.cost.per_rad, request.seed);
  if (!world_.route_graph) return routes;
  const RouteResult on_graph = plan_graph_route(space, request, *world_.route_graph);
  if (on_graph.found())
    routes.push_back({.polyline_m = on_graph.polyline_m,
                      .cost = on_graph.polyline_cost,
                      .searched_by = on_graph.searched_by});
  return routes;
}

std::vector<LegPath> MissionWays::choose_on(const RouteSpace& space, const Together& legs,
                                            const std::vector<double>& price_W, bool quick) const {
  WayRun run{.first = legs.first, .start = legs.start, .quick = quick};
  LegStart there = legs.start;
  for (std::size_t leg = legs.first; leg < legs.first + legs.count; ++leg) {
    const ChoiceContext at_price = context(price_W[leg], &space);
    TurnScores turns(at_price);
    LegRoutes routes{.request = route_request(mission_.legs[leg], there, mission_, options_)};
    routes.request.cost = travel_cost(mission_.legs[leg], at_price, turns);
    routes.routes = routes_of(leg, routes.request, price_W[leg], space);
    if (routes.routes.empty()) break;
    run.contexts.push_back(at_price);
    run.routes.push_back(std::move(routes));
    there = {{stop_of(leg).x_m, stop_of(leg).y_m, 0.0}, true};
  }
  return choose_run(run);
}

double MissionWays::cost_J(const Together& legs, const std::vector<LegPath>& paths,
                           const std::vector<double>& price_W) const {
  if (paths.size() < legs.count) return kNoLimit;
  double sum_J = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::size_t leg = legs.first + i;
    const ChoiceContext at_price = context(price_W[leg], space_);
    sum_J += score_path(paths[i].path, mission_.legs[leg], leg, at_price, options_.nodes)
                 .cost_J(at_price.finite_price_W());
  }
  return sum_J;
}

/// The cheapest of a choice and those on floors without the dear parts on its way: all of them, with those
/// that a way around them meets, and each alone. A part that holds an end of a leg stays.
std::vector<LegPath> MissionWays::cheapest_detour(std::vector<LegPath> best, const Together& legs,
                                                  const std::vector<double>& price_W, bool quick,
                                                  const DearFloor::Parts& kept) const {
  DearFloor::Parts closed;
  const auto met = [&](const std::vector<LegPath>& ways) {
    std::vector<Path> paths;
    for (const LegPath& way : ways) paths.push_back(way.path);
    DearFloor::Parts parts = dear_.along(paths);
    std::erase_if(parts, [&](int part) {
      return std::binary_search(kept.begin(), kept.end(), part) ||
             std::binary_search(closed.begin(), closed.end(), part);
    });
    return parts;
  };
  const DearFloor::Parts first = met(best);
  if (first.empty()) return best;
  double best_J = cost_J(legs, best, price_W);
  const auto around = [&](const DearFloor::Parts& parts) {
    std::vector<LegPath> ways = choose_on(dear_.without(parts), legs, price_W, quick);
    DearFloor::Parts others = met(ways);
    if (const double other_J = cost_J(legs, ways, price_W); other_J < best_J) {
      best_J = other_J;
      best = std::move(ways);
    }
    return others;
  };
  DearFloor::Parts more = first;
  for (int round = 0; round < kMostRounds && !more.empty(); ++round) {
    closed.insert(closed.end(), more.begin(), more.end());
    std::sort(closed.begin(), closed.end());
    more = around(closed);
  }
  for (std::size_t i = 0; closed.size() > 1 && i < std::min(first.size(), kMostAlone); ++i)
    around({first[i]});
  return best;
}

std::vector<LegPath> MissionWays::choose_together(const Together& legs, const std::vector<double>& price_W,
                                                  bool quick) const {
  std::vector<LegQuestion> questions;
  for (std::size_t leg = legs.first; leg < legs.first + legs.count; ++leg)
    questions.push_back(question_of(context(price_W[leg], space_), leg));
  const auto compute = [&] {
    std::vector<Point2> ends_m{{legs.start.pose.x_m, legs.start.pose.y_m}};
    for (const LegQuestion& question : questions) ends_m.push_back({question.goal_x_m, question.goal_y_m});
    return cheapest_detour(choose_on(*space_, legs, price_W, quick), legs, price_W, quick, dear_.at(ends_m));
  };
  return remembered(options_.answers, "ways", compute, quick, legs.start, questions, options_.steps,
                    options_.nodes, options_.accuracy, options_.seed, drifting_constants(plant_));
}

LegPath MissionWays::settled(std::size_t leg, const LegStart& start) const {
  const LegRequest& asked = mission_.legs[leg];
  if (!asked.motion) {
    LegPath path = leg_path(asked, leg, start, mission_, space_, options_);
    if (asked.direction == LegDirection::reverse && !path.infeasibility)
      path.infeasibility = {.constraint = "path", .message = "no way in reverse alone was found"};
    return path;
  }
  LegPath way{.source = "motion"};
  if (space_)
    way.infeasibility = blocked_motion(*prescribed_leg(asked, plant_, start.pose).prescribed, *space_);
  return way;
}

LegStart MissionWays::after(std::size_t leg, const LegPath& path, const LegStart& start) const {
  if (mission_.legs[leg].motion) {
    const Trajectory motion = *prescribed_leg(mission_.legs[leg], plant_, start.pose).prescribed;
    return {.pose = end_pose(motion), .heading_free = false};
  }
  if (path.path.pieces.empty()) return start;
  return {.pose = path.path.end(), .heading_free = false};
}

void MissionWays::check_direction(std::size_t leg) const {
  const LegRequest& asked = mission_.legs[leg];
  if (asked.direction != LegDirection::reverse || may_reverse(world_.robot, asked)) return;
  throw ConfigError({.mark = asked.marks.at("direction"),
                     .key = asked.marks.key_path("direction"),
                     .found = "reverse",
                     .accepted = "any or forward, as the robot file has no limits.reverse_speed_m_s"});
}

/// Says so where only driving backward would do and is not allowed.
void MissionWays::tell_of_reverse(std::size_t leg, const LegStart& start, Infeasibility& reason) const {
  if (mission_.legs[leg].path || mission_.legs[leg].motion || !space_ || !world_.robot.limits) return;
  const bool stated = std::isfinite(world_.robot.limits->reverse_speed_m_s);
  if (stated && mission_.legs[leg].direction != LegDirection::forward) return;
  MissionRequest backward = mission_;
  backward.legs = {mission_.legs[leg]};
  backward.legs.front().direction = LegDirection::any;
  backward.start.pose = start.pose;
  backward.start.heading_given = !start.heading_free;
  MissionWorld world = world_;
  if (!stated) world.robot.limits->reverse_speed_m_s = world.robot.limits->speed_m_s;
  PlanOptions options = options_;
  options.answers = {};
  const std::vector<LegPath> paths =
      MissionWays(backward, world, space_, plant_, options).choose({0.0}, true);
  if (paths.empty() || paths.back().infeasibility) return;
  reason.message += stated
                        ? "; driving backward would do: `direction: any` for this leg"
                        : "; driving backward would do: `limits: {reverse_speed_m_s: ...}` in the robot file";
}

std::vector<LegPath> MissionWays::choose(const std::vector<double>& price_W, bool quick) const {
  std::vector<LegPath> paths;
  for (std::size_t leg = 0; leg < mission_.legs.size(); ++leg) check_direction(leg);
  LegStart here{.pose = mission_.start.pose, .heading_free = !mission_.start.heading_given};
  while (paths.size() < mission_.legs.size()) {
    const std::vector<Together> groups = groups_from(paths.size(), here);
    std::vector<std::vector<LegPath>> chosen(groups.size());
    for_each_index(groups.size(), options_.threads, [&](std::size_t i) {
      chosen[i] = choose_together(groups[i], price_W, quick);
      finish_steps(chosen[i].size());
    });
    bool whole = !groups.empty();
    for (std::size_t i = 0; i < groups.size() && whole; ++i) {
      whole = chosen[i].size() == groups[i].count;
      for (LegPath& path : chosen[i]) {
        here = after(paths.size(), path, here);
        paths.push_back(std::move(path));
      }
    }
    if (paths.size() == mission_.legs.size()) break;
    if (!whole || groups.empty() || !has_choice(paths.size(), here)) {
      LegPath path = settled(paths.size(), here);
      if (path.infeasibility) tell_of_reverse(paths.size(), here, *path.infeasibility);
      here = after(paths.size(), path, here);
      paths.push_back(std::move(path));
      finish_steps();
      if (paths.back().infeasibility) return paths;
    }
  }
  return paths;
}

}  // namespace joulepath
