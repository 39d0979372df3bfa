#include "planner/path/search/route.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>

#include "planner/path/floor/path_conflict.hpp"
#include "planner/path/search/homotopy.hpp"
#include "planner/path/search/route_cache.hpp"
#include "planner/path/search/route_pool.hpp"
#include "planner/path/shape/end_leads.hpp"

namespace joulepath {
namespace {

/// Shaping uses a clearance larger by this margin than the final check, so that rounding cannot fail the
/// check.
constexpr double kShapeMargin_m = 0.001;
constexpr double kArrived_m = 1e-6;

std::string obstruction_text(const char* what, const Collision& c) {
  char text[320];
  std::snprintf(
      text, sizeof text, "%s (%.3f, %.3f) m: the clearance is short by %.3f m to %s at (%.3f, %.3f) m", what,
      c.pose.x_m, c.pose.y_m, c.short_by_m, name_of(c.obstacle.layer), c.obstacle.x_m, c.obstacle.y_m);
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

/// "(x, y) m, d m away"
std::string place_text(const Point2& near, double from_x_m, double from_y_m) {
  char text[120];
  std::snprintf(text, sizeof text, "(%.3f, %.3f) m, %.3f m away", near[0], near[1],
                std::hypot(near[0] - from_x_m, near[1] - from_y_m));
  return text;
}

/// Adds a special message for a place that the map does not contain or does not know.
RouteVerdict told_of_the_map(RouteVerdict verdict, const ObstacleField& field, const char* which) {
  const OccupancyGrid& map = field.map();
  char text[320];
  if (map.contains(map.cell_of(verdict.x_m, verdict.y_m))) {
    const auto nearest = field.nearest(verdict.x_m, verdict.y_m);
    if (nearest.distance_m > 0 || nearest.layer != ObstacleField::Layer::unknown) return verdict;
    std::snprintf(text, sizeof text,
                  "the %s (%.3f, %.3f) m lies on an unknown cell of the map; unknown cells count as occupied",
                  which, verdict.x_m, verdict.y_m);
    verdict.message = text;
    return verdict;
  }
  const ObstacleField::Extent extent = field.extent_m();
  std::snprintf(
      text, sizeof text,
      "the %s (%.3f, %.3f) m lies outside of the map, which covers x from %.2f to %.2f m and y from "
      "%.2f to %.2f m",
      which, verdict.x_m, verdict.y_m, extent.x_min_m, extent.x_max_m, extent.y_min_m, extent.y_max_m);
  verdict.message = text;
  if (map.contains(map.cell_of(verdict.y_m, verdict.x_m))) verdict.message += "; are x and y swapped?";
  return verdict;
}

RouteVerdict unconnected(const FreeSpace& space, const Point2& start, const Point2& goal) {
  RouteVerdict verdict{RouteStatus::no_connection,           goal[0], goal[1], 0, false,
                       space.nearest_reachable(start, goal), ""};
  char text[320];
  if (verdict.nearest_reachable_m) {
    std::snprintf(text, sizeof text,
                  "no way to (%.3f, %.3f) m for this footprint and clearance; nearest reachable place %s",
                  goal[0], goal[1], place_text(*verdict.nearest_reachable_m, goal[0], goal[1]).c_str());
  } else {
    std::snprintf(text, sizeof text,
                  "no way out of the start (%.3f, %.3f) m for this footprint and clearance", start[0],
                  start[1]);
  }
  verdict.message = text;
  return verdict;
}

/// Where a way begins or ends.
struct RouteEnd {
  RouteStatus blocked{};
  const char* name{};
  Pose pose{};
  bool heading_free{};
};

/// Where the heading is free, some heading must fit: the inscribed disc is checked.
std::optional<Collision> standing_collision(const RouteSpace& space, const Pose& pose, bool heading_free) {
  if (!heading_free) return space.checker().pose_collision(pose);
  const double need_m = space.checker().inscribed_radius_m() + space.checker().clearance_m();
  const auto nearest = space.field().nearest(pose.x_m, pose.y_m);
  if (nearest.distance_m >= need_m - FootprintChecker::kTolerance_m) return std::nullopt;
  return Collision{0, pose, need_m - nearest.distance_m, nearest};
}

/// The place nearest to an end where the robot can stand as it should there, on the other end's part of the
/// floor; on any part if the other end is on none.
std::optional<Point2> nearest_standing(const RouteSpace& space, const RouteEnd& end, const Pose& other) {
  const FreeSpace& floor = space.some_heading();
  return floor.nearest_free(
      {end.pose.x_m, end.pose.y_m}, floor.component({other.x_m, other.y_m}), [&](const Point2& p) {
        return !standing_collision(space, {p[0], p[1], end.pose.heading_rad}, end.heading_free);
      });
}

std::optional<RouteVerdict> blocked_end(const RouteSpace& space, const RouteEnd& end, const Pose& other) {
  const auto collision = standing_collision(space, end.pose, end.heading_free);
  if (!collision) return std::nullopt;
  const std::string what = std::string("the robot does not fit at the ") + end.name;
  RouteVerdict verdict =
      told_of_the_map(blocked(end.blocked, what.c_str(), *collision), space.field(), end.name);
  verdict.nearest_reachable_m = nearest_standing(space, end, other);
  if (verdict.nearest_reachable_m)
    verdict.message +=
        "; the robot can stand at " + place_text(*verdict.nearest_reachable_m, end.pose.x_m, end.pose.y_m);
  return verdict;
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
  const RouteEnd start{RouteStatus::start_blocked, "start", request.start, request.start_heading_free};
  const RouteEnd goal{RouteStatus::goal_blocked,
                      "goal",
                      {request.goal_x_m, request.goal_y_m, request.goal_heading_rad.value_or(0)},
                      !request.goal_heading_rad};
  if (auto verdict = blocked_end(space, start, goal.pose)) return verdict;
  return blocked_end(space, goal, start.pose);
}

std::optional<RouteVerdict> no_way(const RouteSpace& space, const RouteRequest& request) {
  if (auto verdict = blocked_ends(space, request)) return verdict;
  const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
  if (is_there_already(request) || space.floor_between(start, goal).connected(start, goal))
    return std::nullopt;
  return unconnected(space.any_heading(), start, goal);
}

bool is_there_already(const RouteRequest& request) {
  return std::hypot(request.goal_x_m - request.start.x_m, request.goal_y_m - request.start.y_m) < kArrived_m;
}

/// Built where it is needed first.
struct RouteSpace::Narrow {
  std::mutex mutex{};
  std::optional<FreeSpace> space{};
};

struct RouteSpace::Others {
  std::mutex mutex{};
  std::map<std::vector<std::int8_t>, std::unique_ptr<RouteSpace>> spaces{};  ///< by the map's cells
};

RouteSpace::~RouteSpace() = default;
RouteSpace::RouteSpace(RouteSpace&&) noexcept = default;
RouteSpace& RouteSpace::operator=(RouteSpace&&) noexcept = default;

RouteSpace::RouteSpace(const OccupancyGrid& map, const OccupancyGrid* keepout, const Footprint& footprint,
                       double clearance_m)
    : field_(std::make_unique<ObstacleField>(map, keepout)),
      checker_(*field_, footprint, clearance_m),
      any_heading_(*field_, checker_.circumscribed_radius_m() + clearance_m) {
  islands_m_ = island_points(any_heading_);
  routes_ = std::make_unique<RouteCache>();
  narrow_ = std::make_unique<Narrow>();
  others_ = std::make_unique<Others>();
  if (!checker_.is_disc()) some_heading_.emplace(*field_, checker_.inscribed_radius_m() + clearance_m);
}

const FreeSpace& RouteSpace::floor_between(const Point2& a_m, const Point2& b_m) const {
  const auto stands = [&](const FreeSpace& floor, const Point2& end_m) {
    return field_->distance_m(end_m[0], end_m[1]) >= floor.radius_m() - FootprintChecker::kTolerance_m;
  };
  const auto serves = [&](const FreeSpace& floor) {
    return floor.connected(a_m, b_m) && stands(floor, a_m) && stands(floor, b_m);
  };
  if (serves(any_heading_)) return any_heading_;
  return serves(some_heading()) ? some_heading() : narrow();
}

const FreeSpace& RouteSpace::narrow() const {
  const std::lock_guard lock(narrow_->mutex);
  if (!narrow_->space) narrow_->space.emplace(*field_, some_heading().radius_m(), FreeSpace::kSmallestCell_m);
  return *narrow_->space;
}

const RouteSpace& RouteSpace::on(const OccupancyGrid& map, const std::function<RouteSpace()>& build) const {
  const std::lock_guard lock(others_->mutex);
  std::unique_ptr<RouteSpace>& other = others_->spaces[map.occupancy_percent];
  if (!other) other = std::make_unique<RouteSpace>(build());
  return *other;
}

RouteResult shape_route(const RouteSpace& space, const RouteRequest& request,
                        const std::vector<Point2>& polyline_m) {
  RouteResult result;
  result.polyline_m = polyline_m;
  result.polyline_cost = polyline_cost(polyline_m, request.cost);
  const FootprintChecker& checker = space.checker();
  const FootprintChecker careful = checker.with_clearance(checker.clearance_m() + kShapeMargin_m);
  // Attempts: as requested; with arcs at ends that have no room for a turn in place; with a stop at every
  // corner.
  RouteRequest bending = request, stopping = request;
  bending.blend_start = bending.blend_goal = true;
  stopping.corners = {CornerPolicy::Kind::stop_turn_go, 0};
  for (const RouteRequest* way :
       {&request, static_cast<const RouteRequest*>(&bending), static_cast<const RouteRequest*>(&stopping)}) {
    const bool leaves_along = way->blend_start && !way->start_heading_free;
    const SmoothPath blended =
        *blend_along_headings(polyline_m, leaves_along ? std::optional(way->start.heading_rad) : std::nullopt,
                              way->blend_goal ? way->goal_heading_rad : std::nullopt, careful, way->corners);
    result.path = with_end_turns(blended.path, request);
    result.corners = blended.corners;
    const auto conflict = path_conflict(checker, result.path);
    if (!conflict) {
      result.verdict = {};
      return result;
    }
    if (way == &request)
      result.verdict = blocked(RouteStatus::no_room_to_turn, "no room on the way at", conflict->deepest);
  }
  result.path = {};
  return result;
}

RouteResult plan_route(const RouteSpace& space, const RouteRequest& request) {
  RouteResult result;
  if (auto verdict = no_way(space, request)) {
    result.verdict = *verdict;
    return result;
  }
  if (is_there_already(request)) return shape_route(space, request, {});
  const std::vector<PooledRoute> routes = pool_routes(space, request, {});
  if (routes.empty()) {
    result.verdict = unconnected(space.any_heading(), {request.start.x_m, request.start.y_m},
                                 {request.goal_x_m, request.goal_y_m});
    return result;
  }
  for (const PooledRoute& route : routes) {
    RouteResult shaped = shape_route(space, request, route.polyline_m);
    shaped.search_iterations = route.search_iterations;
    shaped.searched_by = route.searched_by;
    if (shaped.found()) return shaped;
    if (&route == &routes.front()) result = std::move(shaped);
  }
  return result;
}

}  // namespace joulepath
