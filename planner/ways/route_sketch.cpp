#include "planner/ways/route_sketch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath {
namespace {

constexpr double kFarthestRoom_m = 5, kRoomStep_m = 0.1;

Pose half_turned(Pose pose) {
  pose.heading_rad += std::numbers::pi;
  return pose;
}

/// A polyline whose first part of a length is replaced by a point.
std::vector<Point2> begun_at(const Pose& place, const std::vector<Point2>& route_m, double without_m) {
  std::vector<Point2> rest{{place.x_m, place.y_m}};
  double along_m = 0;
  for (std::size_t i = 1; i < route_m.size(); ++i) {
    along_m += distance_m(route_m[i - 1], route_m[i]);
    if (along_m > without_m || i + 1 == route_m.size()) rest.push_back(route_m[i]);
  }
  return rest;
}

std::vector<Point2> turned_round(std::vector<Point2> route_m) {
  std::reverse(route_m.begin(), route_m.end());
  return route_m;
}

}  // namespace

std::optional<double> way_to_room_m(const FreeSpace& room, const Pose& from, int direction) {
  for (double length_m = 0; length_m < kFarthestRoom_m; length_m += kRoomStep_m) {
    const Pose place = joint::moved(from, direction * length_m);
    if (!room.field().disc_free(place.x_m, place.y_m, room.radius_m())) continue;
    return length_m > 0 ? std::optional(length_m) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<joint::Sketch> sketch_along(RouteDrive drive, const Pose& from, const joint::LegGoal& goal,
                                          const std::vector<Point2>& route_m, int first, int last,
                                          double half_track_m, const FreeSpace& room) {
  const auto along = [&](const Pose& start, const std::vector<Point2>& route,
                         const std::optional<double>& heading_rad) {
    return joint::along_route(start, route, heading_rad, first, last, half_track_m);
  };
  if (drive == RouteDrive::forward) return along(from, route_m, goal.heading_rad);
  if (drive == RouteDrive::reverse)
    return joint::reversed(along(half_turned(from), route_m, joint::turned(goal).heading_rad));
  if (drive == RouteDrive::out_in_reverse) {
    const std::optional<double> out_m = way_to_room_m(room, from, -1);
    if (!out_m) return std::nullopt;
    const Pose outside = joint::moved(from, -*out_m);
    joint::Sketch sketch = joint::straight(-*out_m);
    joint::append(sketch, along(outside, begun_at(outside, route_m, *out_m), goal.heading_rad));
    return sketch;
  }
  if (!goal.heading_rad) return std::nullopt;
  const Pose at_goal{goal.at_m[0], goal.at_m[1], *goal.heading_rad};
  const std::optional<double> in_m = way_to_room_m(room, at_goal, 1);
  if (!in_m) return std::nullopt;
  const Pose outside = joint::moved(at_goal, *in_m);
  joint::Sketch sketch =
      along(from, turned_round(begun_at(outside, turned_round(route_m), *in_m)), goal.heading_rad);
  joint::append(sketch, joint::straight(-*in_m));
  return sketch;
}

}  // namespace joulepath
