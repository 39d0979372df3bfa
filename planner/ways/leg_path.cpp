#include "planner/ways/leg_path.hpp"

#include <cmath>
#include <cstdio>

#include "planner/path/shape/bezier_chain.hpp"

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

LegPath along_bezier(const LegRequest& leg, const Pose& start) {
  const BezierFrame frame =
      leg.path->frame == PathRequest::Frame::start ? BezierFrame::start : BezierFrame::map;
  BezierChainResult chain = bezier_chain(leg.path->bezier_m, start, frame);
  if (!chain.ok()) {
    const BezierFinding& defect = chain.defects.front();
    refuse(leg.marks, "path", defect.message,
           "a chain of cubic Bezier curves without cusps or gaps, at least 1 mm long");
  }
  return {.path = std::move(chain.path), .source = "bezier"};
}

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f m", value);
  return text;
}

/// Where the file names the stop: ` (mission.yaml:13:10: legs[1].to)`.
std::string named_at(const ItemMarks& marks) {
  const SourceMark& mark = marks.at("to");
  if (mark.file.empty()) return "";
  return " (" + mark.file + ":" + std::to_string(mark.line) + ":" + std::to_string(mark.column) + ": " +
         marks.key_path("to") + ")";
}

Infeasibility unreachable(const RouteVerdict& verdict, const Station& goal, const ItemMarks& marks) {
  Infeasibility reason{.constraint = "path",
                       .x_m = verdict.x_m,
                       .y_m = verdict.y_m,
                       .amount = verdict.short_by_m,
                       .unit = "m",
                       .message = verdict.message};
  if (verdict.status == RouteStatus::goal_blocked) reason.message += named_at(marks);
  if (verdict.nearest_reachable_m) {
    const auto [x_m, y_m] = *verdict.nearest_reachable_m;
    reason.relaxation = {{"x_m", x_m}, {"y_m", y_m}};
    if (reason.amount == 0.0) reason.amount = std::hypot(goal.x_m - x_m, goal.y_m - y_m);
  }
  return reason;
}

LegPath over_the_floor(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                       const MissionRequest& mission, const RouteSpace& space, const PlanOptions& options) {
  const Station& goal = mission.stations.at(leg.to);
  const RouteResult route = plan_route(space, route_request(leg, start, mission, options));
  if (route.verdict.status == RouteStatus::start_blocked && leg_index == 0)
    refuse(mission.start.marks, mission.start.station.empty() ? "x_m" : "station",
           "a start where the robot does not fit: " + route.verdict.message,
           "a free place, the whole footprint and clearance_m around it",
           "short by " + metres(route.verdict.short_by_m));
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

LegPath leg_path(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                 const MissionRequest& mission, const RouteSpace* space, const PlanOptions& options) {
  if (leg.path && leg.path->ready) return {.path = *leg.path->ready, .source = "given"};
  if (leg.path) return along_bezier(leg, start.pose);
  if (!space)
    refuse(leg.marks, "to", "a leg to a station without a map",
           "`map:` in the mission, or a leg with `path:` or `motion:`");
  return over_the_floor(leg, leg_index, start, mission, *space, options);
}

}  // namespace joulepath
