#include "benchmarks/missions/draw.hpp"

#include "tests/planner/path/grids.hpp"

namespace joulepath::bench {
namespace {

constexpr double kClearance_m = 0.05;
constexpr double kDwell_s = 5.0;

}  // namespace

std::vector<Floor> floors(const Robot& robot) {
  std::vector<Floor> all;
  const auto add = [&](const char* name, const std::optional<OccupancyGrid>& map,
                       const std::optional<OccupancyGrid>& keepout, const ObstacleField::Extent& box) {
    if (!map) return;
    all.push_back({name,
                   {.robot = robot, .map = *map},
                   RouteSpace(*map, keepout ? &*keepout : nullptr, robot.footprint, kClearance_m),
                   box});
  };
  add("Nav2 warehouse", nav2_warehouse(), nav2_warehouse_keepout(), {-14.0, 14.0, -24.0, 24.0});
  add("Nav2 depot", nav2_depot(), std::nullopt, {1.0, 29.0, 1.0, 14.0});
  add("generated warehouse", warehouse_grid(1), std::nullopt, {1.5, 58.5, 1.5, 38.5});
  return all;
}

Station random_place(const Floor& floor, std::mt19937& random, const Station* other) {
  std::uniform_real_distribution<double> x(floor.box.x_min_m, floor.box.x_max_m),
      y(floor.box.y_min_m, floor.box.y_max_m);
  for (;;) {
    const Station place{.x_m = x(random), .y_m = y(random)};
    RouteRequest request;
    request.start = {place.x_m, place.y_m, 0.0};
    request.start_heading_free = true;
    request.goal_x_m = other ? other->x_m : place.x_m;
    request.goal_y_m = other ? other->y_m : place.y_m;
    if (!no_way(floor.space, request)) return place;
  }
}

DrawnMission random_mission(const Floor& floor, std::mt19937& random) {
  DrawnMission drawn;
  MissionRequest& base = drawn.base;
  base.name = "random";
  base.stations["dock"] = random_place(floor, random, nullptr);
  const Station& dock = base.stations["dock"];
  base.start = {.station = "dock", .pose = {dock.x_m, dock.y_m, 0.0}, .heading_given = false};
  std::uniform_int_distribution<int> payload_kg(1, 4);
  for (int k = 1; k <= 3; ++k) {
    const std::string name = "stop_" + std::to_string(k);
    base.stations[name] = random_place(floor, random, &dock);
    drawn.visit.push_back({.kind = VisitRequest::Kind::pick,
                           .station = name,
                           .payload_kg = static_cast<double>(payload_kg(random)),
                           .payload_given = true,
                           .dwell_s = kDwell_s});
  }
  drawn.visit.push_back({.kind = VisitRequest::Kind::drop, .station = "dock"});
  return drawn;
}

std::vector<LegRequest> DrawnMission::legs_in(const std::vector<std::size_t>& order) const {
  std::vector<LegRequest> legs;
  double payload_kg = 0.0;
  for (const std::size_t k : order) {
    legs.push_back(
        {.to = visit[k].station, .payload = {payload_kg, payload_kg}, .dwell_s = visit[k].dwell_s});
    payload_kg += visit[k].payload_kg;
  }
  return legs;
}

MissionRequest DrawnMission::with(const std::vector<LegRequest>& legs) const {
  MissionRequest mission = base;
  mission.legs = legs;
  return mission;
}

}  // namespace joulepath::bench
