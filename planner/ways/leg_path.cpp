#include "planner/ways/leg_path.hpp"

#include <cmath>

#include "planner/legs/floor_check.hpp"
#include "planner/path/shape/bezier_chain.hpp"
// Design: docs/decisions/0201-routes-and-floor.md

namespace joulepath {
namespace {

[[noreturn]] void refuse(const ItemMarks& marks, const std::string& key, const std::string& found,
                         const std::string& accepted, const std::string& hint = {}) {
  throw ConfigError({.mark = marks.at(key),
                     .key = marks.key_path(key),
                     .found = found,
                     .accepted = accepted,
                     .hint = hint});
}

bool in_map(const std::vector<BezierPoints>& curves_m, const OccupancyGrid& map) {
  for (const BezierPoints& curve : curves_m)
    for (const auto& [x_m, y_m] : curve)
      if (!map.contains(map.cell_of(x_m, y_m))) return false;
  return true;
}

/// A hint where control points seem to be given in the other frame; empty where they do not. `space` may be
/// null.
std::string frame_hint(const PathRequest& path, const Pose& start, const RouteSpace* space) {
  const auto [x_m, y_m] = path.bezier_m.front().front();
  if (path.frame == PathRequest::Frame::map) {
    const bool counts_from_robot = x_m == 0 && y_m == 0;
    return counts_from_robot ? "points relative to the robot (x ahead, y to its left) need `frame: start`"
                             : "";
  }
  const BezierChainResult on_map = bezier_chain(path.bezier_m, start, BezierFrame::map);
  const bool begins_here = on_map.ok() && !(space && blocked_path(on_map.path, *space));
  const bool begins_elsewhere =
      std::hypot(x_m, y_m) > 0 && space && in_map(path.bezier_m, space->field().map());
  return begins_here || begins_elsewhere ? "these look like coordinates of the map: `frame: map`?" : "";
}

LegPath along_bezier(const LegRequest& leg, const Pose& start, const RouteSpace* space) {
  const BezierFrame frame =
      leg.path->frame == PathRequest::Frame::start ? BezierFrame::start : BezierFrame::map;
  BezierChainResult chain = bezier_chain(leg.path->bezier_m, start, frame);
  if (!chain.ok()) {
    const BezierFinding& defect = chain.defects.front();
    refuse(leg.marks, "path", defect.message,
           "a chain of cubic Bezier curves without cusps or gaps, at least 1 mm long",
           defect.kind == BezierFinding::Kind::gap ? frame_hint(*leg.path, start, space) : "");
  }
  return {.path = std::move(chain.path), .source = "bezier"};
}

/// A path given by the mission, checked against the floor where there is one.
LegPath along_given(const LegRequest& leg, const Pose& start, const RouteSpace* space) {
  LegPath way = leg.path->ready ? LegPath{.path = *leg.path->ready, .source = "given"}
                                : along_bezier(leg, start, space);
  if (space) way.infeasibility = blocked_path(way.path, *space);
  if (!way.infeasibility || leg.path->ready) return way;
  if (const std::string hint = frame_hint(*leg.path, start, space); !hint.empty())
    way.infeasibility->message += "; " + hint;
  return way;
}

std::string place_of(const SourceMark& mark, const std::string& key) {
  if (mark.file.empty()) return "";
  return mark.file + ":" + std::to_string(mark.line) + ":" + std::to_string(mark.column) + ": " + key;
}

/// Where the files name the stop: ` (mission.yaml:13:10: legs[1].to, mission.yaml:8:10: stations.shelf)`.
std::string named_at(const ItemMarks& marks, const ItemMarks& station) {
  const std::string leg = place_of(marks.at("to"), marks.key_path("to"));
  const std::string place = place_of(station.item, station.path);
  if (leg.empty()) return "";
  return " (" + leg + (place.empty() ? "" : ", " + place) + ")";
}

Infeasibility unreachable(const RouteVerdict& verdict, const Station& goal, const ItemMarks& marks) {
  Infeasibility reason{.constraint = "path",
                       .x_m = verdict.x_m,
                       .y_m = verdict.y_m,
                       .amount = verdict.short_by_m,
                       .unit = "m",
                       .message = verdict.message};
  if (verdict.status == RouteStatus::goal_blocked) reason.message += named_at(marks, goal.marks);
  if (verdict.nearest_reachable_m && verdict.status != RouteStatus::start_blocked) {
    const auto [x_m, y_m] = *verdict.nearest_reachable_m;
    reason.relaxation = {{"x_m", x_m}, {"y_m", y_m}};
    reason.amount = std::hypot(goal.x_m - x_m, goal.y_m - y_m);
  }
  return reason;
}

constexpr const char* kFreePlace = "a free place, the whole footprint and clearance_m around it";

[[noreturn]] void refuse_start(const MissionRequest& mission, const RouteVerdict& verdict) {
  if (mission.start.station.empty() && !mission.marks.keys.contains("start"))
    throw ConfigError({.mark = mission.marks.at(mission.visit.empty() ? "legs" : "visit"),
                       .key = "start",
                       .found = "nothing, and at the map's origin of coordinates " + verdict.message,
                       .accepted = std::string("station, or x_m and y_m, of ") + kFreePlace,
                       .hint = ""});
  refuse(mission.start.marks, mission.start.station.empty() ? "x_m" : "station",
         "a start where the robot does not fit: " + verdict.message, kFreePlace);
}

LegPath over_the_floor(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                       const MissionRequest& mission, const RouteSpace& space, const PlanOptions& options) {
  const Station& goal = mission.stations.at(leg.to);
  const RouteResult route = plan_route(space, route_request(leg, start, mission, options));
  if (route.verdict.status == RouteStatus::start_blocked && leg_index == 0)
    refuse_start(mission, route.verdict);
  if (!route.found()) return {.infeasibility = unreachable(route.verdict, goal, leg.marks)};
  return {.path = route.path, .source = route.searched_by};
}

}  // namespace

RouteRequest route_request(const LegRequest& leg, const LegStart& start, const MissionRequest& mission,
                           const PlanOptions& options) {
  const Station& goal = mission.stations.at(leg.to);
  return {.start = start.pose,
          .goal_x_m = goal.x_m,
          .goal_y_m = goal.y_m,
          .goal_heading_rad = goal.heading_rad,
          .start_heading_free = start.heading_free,
          .seed = options.seed};
}

void refuse_blocked_start(const MissionRequest& mission, const RouteSpace& space, const RouteRequest& way) {
  const auto verdict = blocked_ends(space, way);
  if (verdict && verdict->status == RouteStatus::start_blocked) refuse_start(mission, *verdict);
}

void refuse_blocked_goals(const MissionRequest& mission, const RouteSpace& space) {
  const auto check = [&](const std::string& name) {
    if (name.empty()) return;  // of a given path or motion
    const LegStart start{.pose = mission.start.pose, .heading_free = !mission.start.heading_given};
    const auto verdict = blocked_ends(space, route_request({.to = name}, start, mission, {}));
    if (!verdict || verdict->status != RouteStatus::goal_blocked) return;
    const ItemMarks& marks = mission.stations.at(name).marks;
    throw ConfigError(
        {marks.item, marks.path, "a goal where the robot does not fit: " + verdict->message, kFreePlace, ""});
  };
  for (const LegRequest& leg : mission.legs) check(leg.to);
  for (const VisitRequest& visit : mission.visit) check(visit.station);
}

LegPath leg_path(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                 const MissionRequest& mission, const RouteSpace* space, const PlanOptions& options) {
  if (leg.path) return along_given(leg, start.pose, space);
  if (!space)
    refuse(leg.marks, "to", "a leg to a station without a map",
           "`map:` in the mission, or a leg with `path:` or `motion:`");
  return over_the_floor(leg, leg_index, start, mission, *space, options);
}

}  // namespace joulepath
