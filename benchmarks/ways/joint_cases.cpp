#include "benchmarks/ways/joint_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::ways {
namespace {

constexpr double kJointClearance_m = 0.05, kCell_m = 0.05, kPi = std::numbers::pi;

class Draw {
 public:
  Draw(unsigned seed, const std::string& kind, unsigned index) {
    std::seed_seq seeds{seed, index, static_cast<unsigned>(kind.front()), static_cast<unsigned>(kind.back())};
    random_.seed(seeds);
  }
  double operator()(double from, double to) {
    return from + (to - from) * (static_cast<double>(random_()) / 4294967296.0);
  }
  double angle_rad() { return (*this)(-kPi, kPi); }

 private:
  std::mt19937 random_{};
};

void fill(OccupancyGrid& grid, double x0_m, double y0_m, double x1_m, double y1_m) {
  for (double y_m = y0_m + 0.5 * kCell_m; y_m < y1_m; y_m += kCell_m)
    for (double x_m = x0_m + 0.5 * kCell_m; x_m < x1_m; x_m += kCell_m) {
      const auto cell = grid.cell_of(x_m, y_m);
      if (grid.contains(cell)) grid.occupancy_percent[grid.index_of(cell)] = 100;
    }
}

/// Slots of 0.8, 0.9 and 1 m in a wall, 1.5 m deep, below a floor of 9 x 5 m.
OccupancyGrid docks() {
  OccupancyGrid grid = free_grid(180, 140, kCell_m);
  double x_m = 0;
  for (int k = 0; k < 6; ++k) {
    const double wide_m = 0.8 + 0.1 * (k % 3);
    fill(grid, x_m, 0.2, x_m + 0.6, 1.7);
    x_m += 0.6 + wide_m;
  }
  fill(grid, x_m, 0.2, 9, 1.7);
  fill(grid, 0, 0, 9, 0.2);
  return grid;
}

/// Two rooms with doors of 0.9 to 1.1 m, boxes and a slalom of racks on 12 x 8 m.
OccupancyGrid rooms() {
  OccupancyGrid grid = free_grid(240, 160, kCell_m);
  fill(grid, 4.0, 0, 4.2, 1.5);
  fill(grid, 4.0, 2.5, 4.2, 5.5);
  fill(grid, 4.0, 6.4, 4.2, 8);
  for (int k = 0; k < 3; ++k) fill(grid, 6.0 + 1.8 * k, k % 2 ? 3.2 : 0, 6.3 + 1.8 * k, k % 2 ? 8 : 4.6);
  fill(grid, 1.6, 3.6, 2.3, 4.2);
  fill(grid, 2.6, 6.2, 3.1, 6.9);
  return grid;
}

World world_of(const std::string& name, OccupancyGrid grid) {
  MissionWorld world{.robot = testing::nomad(), .map = std::move(grid)};
  RouteSpace space(*world.map, nullptr, world.robot.footprint, kJointClearance_m);
  return {name, std::move(world), std::move(space), {}};
}

bool stands(const World& world, const Point2& at_m) {
  return world.space.field().disc_free(at_m[0], at_m[1], world.space.any_heading().radius_m() + 0.01);
}

Point2 free_place(const World& world, Draw& draw) {
  const auto box = world.space.field().extent_m();
  while (true) {
    const Point2 at_m{draw(box.x_min_m + 0.4, box.x_max_m - 0.4), draw(box.y_min_m + 0.4, box.y_max_m - 0.4)};
    if (stands(world, at_m)) return at_m;
  }
}

void add_leg(MissionRequest& mission, const Point2& at_m, const std::optional<double>& heading_rad) {
  const std::string name = "stop_" + std::to_string(mission.legs.size() + 1);
  mission.stations[name] = {.x_m = at_m[0], .y_m = at_m[1], .heading_rad = heading_rad};
  mission.legs.push_back({.to = name});
}

double turning_rad(const Pose& start, const Point2& goal_m, double heading_rad) {
  const double bearing_rad = std::atan2(goal_m[1] - start.y_m, goal_m[0] - start.x_m);
  return std::abs(wrapped_angle_rad(bearing_rad - start.heading_rad)) +
         std::abs(wrapped_angle_rad(heading_rad - bearing_rad));
}

void draw_open(MissionRequest& mission, Draw& draw, unsigned index, double least_m, double most_m,
               double least_turning_rad) {
  while (true) {
    mission.start.pose = {15, 15, draw.angle_rad()};
    const double reach_m = least_m * std::exp(draw(0, std::log(most_m / least_m))),
                 bearing_rad = draw.angle_rad(), heading_rad = draw.angle_rad();
    const Point2 goal_m{15 + reach_m * std::cos(bearing_rad), 15 + reach_m * std::sin(bearing_rad)};
    const bool asked = index % 2 == 1 || least_turning_rad > kPi / 2;
    if (turning_rad(mission.start.pose, goal_m, heading_rad) < least_turning_rad) continue;
    return add_leg(mission, goal_m, asked ? std::optional(heading_rad) : std::nullopt);
  }
}

/// Even cases begin on the floor and end in a slot, the others the other way round; the robot looks into the
/// slot or out of it.
void draw_docking(MissionRequest& mission, const World& world, Draw& draw, unsigned index) {
  const int slot = static_cast<int>(index / 2) % 6;
  double x_m = 0.6;
  for (int k = 0; k < slot; ++k) x_m += 0.6 + 0.8 + 0.1 * (k % 3);
  x_m += 0.5 * (0.8 + 0.1 * (slot % 3));
  const Pose in_slot{x_m, draw(0.75, 1.2), (index / 12) % 2 ? 0.5 * kPi : -0.5 * kPi};
  Point2 place_m = free_place(world, draw);
  while (place_m[1] < 2.3) place_m = free_place(world, draw);
  const double heading_rad = draw.angle_rad();
  if (index % 2 == 0) {
    mission.start.pose = {place_m[0], place_m[1], heading_rad};
    add_leg(mission, {in_slot.x_m, in_slot.y_m}, in_slot.heading_rad);
  } else {
    mission.start.pose = in_slot;
    add_leg(mission, place_m, (index / 4) % 2 ? std::optional(heading_rad) : std::nullopt);
  }
}

void draw_places(MissionRequest& mission, const World& world, Draw& draw, unsigned index, int legs) {
  const Point2 from_m = free_place(world, draw);
  mission.start.pose = {from_m[0], from_m[1], draw.angle_rad()};
  Point2 last_m = from_m;
  for (int k = 0; k < legs; ++k) {
    Point2 place_m = free_place(world, draw);
    while (distance_m(place_m, last_m) < 1 || !world.space.any_heading().connected(place_m, last_m))
      place_m = free_place(world, draw);
    const double heading_rad = draw.angle_rad();
    const bool asked = k + 1 == legs && index % 2 == 1;
    add_leg(mission, place_m, asked ? std::optional(heading_rad) : std::nullopt);
    last_m = place_m;
  }
}

}  // namespace

const std::vector<std::string>& joint_kinds() {
  static const std::vector<std::string> kinds{"open", "corner", "docking", "obstacles", "stops"};
  return kinds;
}

JointFloors::JointFloors() {
  worlds_.push_back(world_of("empty", free_grid(600, 600, kCell_m)));
  worlds_.push_back(world_of("docks", docks()));
  worlds_.push_back(world_of("rooms", rooms()));
}

const World& JointFloors::of(const std::string& kind) const {
  if (kind == "docking") return worlds_[1];
  return kind == "obstacles" || kind == "stops" ? worlds_[2] : worlds_[0];
}

JointCase joint_case(const JointFloors& floors, const std::string& kind, unsigned seed, unsigned index) {
  JointCase one{.name = kind + " " + std::to_string(index), .world = &floors.of(kind)};
  one.mission.name = kind;
  one.mission.clearance_m = kJointClearance_m;
  Draw draw(seed, kind, index);
  if (kind == "open") draw_open(one.mission, draw, index, 0.7, 10, 0);
  if (kind == "corner") draw_open(one.mission, draw, index, 0.3, 2, 0.75 * kPi);
  if (kind == "docking") draw_docking(one.mission, *one.world, draw, index);
  if (kind == "obstacles") draw_places(one.mission, *one.world, draw, index, 1);
  if (kind == "stops") draw_places(one.mission, *one.world, draw, index, 2);
  return one;
}

}  // namespace joulepath::ways
