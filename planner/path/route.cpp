#include "planner/path/route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "planner/path/lattice.hpp"
#include "planner/path/polyline.hpp"
#include "planner/path/rate_table.hpp"

namespace joulepath {
namespace {

/// Shaping keeps this much more away than the final check, so that it cannot fail by rounding.
constexpr double kShapeMargin_m = 0.001;
constexpr double kWorthSwitching = 1e-4;
constexpr double kArrived_m = 1e-6;

std::string obstruction_text(const char* what, const Collision& c) {
  char text[320];
  std::snprintf(text, sizeof text,
                "%s (%.3f, %.3f) m: the clearance is short by %.3f m to %s at (%.3f, %.3f) m", what,
                c.pose.x_m, c.pose.y_m, c.short_by_m,
                c.obstacle.layer == ObstacleField::Layer::keepout ? "the keep-out area" : "the obstacle",
                c.obstacle.x_m, c.obstacle.y_m);
  return text;
}

RouteVerdict blocked(RouteStatus status, const char* what, const Collision& c) {
  RouteVerdict verdict{status,
                       c.pose.x_m,
                       c.pose.y_m,
                       c.short_by_m,
                       c.obstacle.layer == ObstacleField::Layer::keepout,
                       std::nullopt,
                       obstruction_text(what, c)};
  return verdict;
}

RouteVerdict unconnected(const FreeSpace& space, const Point2& start, const Point2& goal) {
  RouteVerdict verdict{RouteStatus::no_connection,           goal[0], goal[1], 0, false,
                       space.nearest_reachable(start, goal), ""};
  char text[320];
  if (verdict.nearest_reachable_m) {
    const Point2& near = *verdict.nearest_reachable_m;
    std::snprintf(
        text, sizeof text,
        "no way to (%.3f, %.3f) m for this footprint and clearance; nearest reachable place (%.3f, %.3f) m, "
        "%.3f m away",
        goal[0], goal[1], near[0], near[1], std::hypot(near[0] - goal[0], near[1] - goal[1]));
  } else {
    std::snprintf(text, sizeof text,
                  "no way out of the start (%.3f, %.3f) m for this footprint and clearance", start[0],
                  start[1]);
  }
  verdict.message = text;
  return verdict;
}

/// The taut polyline of the better of OMPL's solution and a lattice's (or, in narrow places, the grid's) own.
void search(const FreeSpace& space, const RouteRequest& request, RouteResult& result) {
  const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
  FreeSpace::Cells cells = FreeSpace::Cells::clear;
  std::vector<Point2> cell_route =
      Lattice(space).route(start, goal, DiscLineCheck(space, start, goal, cells));
  if (cell_route.empty()) cell_route = space.cell_route(start, goal, cells);
  if (cell_route.empty()) cell_route = space.cell_route(start, goal, cells = FreeSpace::Cells::free);
  const DiscLineCheck free(space, start, goal, cells);
  const SearchResult found =
      search_polyline(space, {start, goal, cells, request.planner, request.cost, request.seed});
  result.search_iterations = found.iterations;
  result.searched_by = found.iterations == 0 ? "line of sight" : found.planner;
  if (!found.polyline_m.empty()) result.polyline_m = pull_taut(found.polyline_m, free, request.cost);
  if (found.iterations == 0 || cell_route.empty()) return;
  const auto taut = pull_taut(cell_route, free, request.cost);
  for (std::size_t i = 0; i + 1 < taut.size(); ++i)
    if (!free(taut[i], taut[i + 1])) return;
  if (result.polyline_m.empty() ||
      polyline_cost(taut, request.cost) <
          (1 - kWorthSwitching) * polyline_cost(result.polyline_m, request.cost)) {
    result.polyline_m = taut;
    result.searched_by = "lattice";
  }
}

Path with_end_turns(const Path& inner, const RouteRequest& request) {
  Path path;
  if (!inner.pieces.empty()) {
    if (!request.start_heading_free) append_turn_to(path, request.start, inner.start().heading_rad);
    path.pieces.insert(path.pieces.end(), inner.pieces.begin(), inner.pieces.end());
  }
  if (request.goal_heading_rad) append_turn_to(path, request.start, *request.goal_heading_rad);
  return path;
}

}  // namespace

std::optional<RouteVerdict> blocked_ends(const RouteSpace& space, const RouteRequest& request) {
  // Where the heading is free it is enough that some heading fits: the inscribed disc.
  const auto check = [&](const Pose& pose, bool heading_free) -> std::optional<Collision> {
    if (!heading_free) return space.checker().pose_collision(pose);
    const double need_m = space.checker().inscribed_radius_m() + space.checker().clearance_m();
    const auto nearest = space.field().nearest(pose.x_m, pose.y_m);
    if (nearest.distance_m >= need_m - FootprintChecker::kTolerance_m) return std::nullopt;
    return Collision{0, pose, need_m - nearest.distance_m, nearest};
  };
  const Pose goal{request.goal_x_m, request.goal_y_m, request.goal_heading_rad.value_or(0)};
  if (const auto c = check(request.start, request.start_heading_free))
    return blocked(RouteStatus::start_blocked, "the robot does not fit at the start", *c);
  if (const auto c = check(goal, !request.goal_heading_rad))
    return blocked(RouteStatus::goal_blocked, "the robot does not fit at the goal", *c);
  return std::nullopt;
}

RouteSpace::RouteSpace(const OccupancyGrid& map, const OccupancyGrid* keepout, const Footprint& footprint,
                       double clearance_m)
    : field_(std::make_unique<ObstacleField>(map, keepout)),
      checker_(*field_, footprint, clearance_m),
      any_heading_(*field_, checker_.circumscribed_radius_m() + clearance_m) {
  if (!checker_.is_disc()) some_heading_.emplace(*field_, checker_.inscribed_radius_m() + clearance_m);
}

namespace {

/// Lead lengths tried for a blend at an end.
constexpr double kLeads_m[] = {0.3, 0.5, 0.8, 1.2, 1.8};

/// The polyline with a lead along the heading at an end, its corner blended: of the leads that are free, the
/// one that turns least in place, then the shortest. Absent where there is no room.
std::optional<SmoothPath> with_lead(const std::vector<Point2>& line, bool at_start, double heading_rad,
                                    const FootprintChecker& careful, const CornerPolicy& policy) {
  std::optional<SmoothPath> best;
  for (const double lead_m : kLeads_m) {
    std::vector<Point2> led = line;
    const double dx = lead_m * std::cos(heading_rad), dy = lead_m * std::sin(heading_rad);
    if (at_start) {
      led.insert(led.begin() + 1, {line.front()[0] + dx, line.front()[1] + dy});
    } else {
      led.insert(led.end() - 1, {line.back()[0] - dx, line.back()[1] - dy});
    }
    SmoothPath smooth = smooth_polyline(led, careful, policy);
    const CornerReport& corner = at_start ? smooth.corners.front() : smooth.corners.back();
    if (corner.radius_m == 0 || careful.first_collision(smooth.path)) continue;
    const double turned_rad = smooth.path.turned_rad();
    const bool less_turning = !best || turned_rad < best->path.turned_rad() - 1e-9;
    const bool as_much = best && turned_rad < best->path.turned_rad() + 1e-9;
    if (less_turning || (as_much && smooth.path.distance_m() < best->path.distance_m()))
      best = std::move(smooth);
  }
  return best;
}

SmoothPath smooth_with_leads(const std::vector<Point2>& polyline_m, const RouteRequest& request,
                             const FootprintChecker& careful, const CornerPolicy& policy) {
  SmoothPath smooth = smooth_polyline(polyline_m, careful, policy);
  if (polyline_m.size() < 2 || policy.kind == CornerPolicy::Kind::stop_turn_go) return smooth;
  const auto differ = [](double a_rad, double b_rad) {
    return std::abs(wrapped_angle_rad(a_rad - b_rad)) > 1e-6;
  };
  if (request.blend_start && !request.start_heading_free &&
      differ(smooth.path.start().heading_rad, request.start.heading_rad))
    if (auto led = with_lead(smooth.polyline_m, true, request.start.heading_rad, careful, policy))
      smooth = *led;
  if (request.blend_goal && request.goal_heading_rad &&
      differ(smooth.path.end().heading_rad, *request.goal_heading_rad))
    if (auto led = with_lead(smooth.polyline_m, false, *request.goal_heading_rad, careful, policy))
      smooth = *led;
  return smooth;
}

}  // namespace

RouteResult shape_route(const RouteSpace& space, const RouteRequest& request,
                        const std::vector<Point2>& polyline_m) {
  RouteResult result;
  result.polyline_m = polyline_m;
  result.polyline_cost = polyline_cost(polyline_m, request.cost);
  const FootprintChecker& checker = space.checker();
  const FootprintChecker careful = checker.with_clearance(checker.clearance_m() + kShapeMargin_m);
  // As asked; bending at the ends where there is no room to turn on the spot; stopping at every corner.
  RouteRequest bending = request, stopping = request;
  bending.blend_start = bending.blend_goal = true;
  stopping.corners = {CornerPolicy::Kind::stop_turn_go, 0};
  for (const RouteRequest* way :
       {&request, static_cast<const RouteRequest*>(&bending), static_cast<const RouteRequest*>(&stopping)}) {
    const SmoothPath smooth = smooth_with_leads(polyline_m, *way, careful, way->corners);
    result.path = with_end_turns(smooth.path, request);
    result.corners = smooth.corners;
    const auto collision = checker.first_collision(result.path);
    if (!collision) {
      result.verdict = {};
      return result;
    }
    if (way != &request) continue;
    result.verdict = blocked(RouteStatus::no_room_to_turn, "no room on the way at",
                             checker.worst_collision(result.path).value_or(*collision));
  }
  result.path = {};
  return result;
}

RouteResult plan_route(const RouteSpace& space, const RouteRequest& request) {
  RouteResult result;
  if (auto verdict = blocked_ends(space, request)) {
    result.verdict = *verdict;
    return result;
  }
  const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
  if (std::hypot(goal[0] - start[0], goal[1] - start[1]) < kArrived_m) return shape_route(space, request, {});
  const bool any_heading = space.any_heading().connected(start, goal);
  if (!any_heading && !space.some_heading().connected(start, goal)) {
    result.verdict = unconnected(space.any_heading(), start, goal);
    return result;
  }
  RateTable table(request.cost, space.field().extent_m());
  RouteRequest quick = request;
  quick.cost = table.cost();
  search(any_heading ? space.any_heading() : space.some_heading(), quick, result);
  if (result.polyline_m.empty()) {
    result.verdict = unconnected(space.any_heading(), start, goal);
    return result;
  }
  RouteResult shaped = shape_route(space, request, result.polyline_m);
  shaped.search_iterations = result.search_iterations;
  shaped.searched_by = result.searched_by;
  return shaped;
}

}  // namespace joulepath
