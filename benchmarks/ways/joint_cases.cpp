#include "benchmarks/ways/joint_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::ways {
namespace {

constexpr double kJointClearance_m = 0.05, kCell_m = 0.05, kPi = std::numbers::pi;
constexpr std::array kDeadEnds_m{0.9, 1.0, 1.1};
constexpr double kBetweenDeadEnds_m = 1.5;

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

/// Dead ends of 0.9, 1 and 1.1 m, 3 m deep, below a floor of 10 x 5 m.
OccupancyGrid dead_ends() {
  OccupancyGrid grid = free_grid(200, 164, kCell_m);
  fill(grid, 0, 0, 10, 0.2);
  double x_m = 0;
  for (const double wide_m : kDeadEnds_m) {
    fill(grid, x_m, 0.2, x_m + kBetweenDeadEnds_m, 3.2);
    x_m += kBetweenDeadEnds_m + wide_m;
  }
  fill(grid, x_m, 0.2, 10, 3.2);
  return grid;
}

/// A robot that turns on the spot within 1.3 m only.
Robot long_robot() {
  Robot robot = testing::nomad();
  robot.footprint = {.polygon_m = {{-0.3, -0.25}, {0.6, -0.25}, {0.6, 0.25}, {-0.3, 0.25}}};
  return robot;
}

World world_of(const std::string& name, OccupancyGrid grid, Robot robot = testing::nomad()) {
  MissionWorld world{.robot = std::move(robot), .map = std::move(grid)};
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

void draw_behind(MissionRequest& mission, Draw& draw) {
  const double heading_rad = draw.angle_rad(), reach_m = std::exp(draw(0, std::log(10)));
  mission.start.pose = {15, 15, heading_rad};
  add_leg(mission, {15 - reach_m * std::cos(heading_rad), 15 - reach_m * std::sin(heading_rad)}, heading_rad);
}

/// Even cases begin on the floor and end in a slot, the others the other way round; the robot looks into the
/// slot or out of it.
void draw_docking(MissionRequest& mission, const World& world, Draw& draw, unsigned index, bool looks_out) {
  const int slot = static_cast<int>(index / 2) % 6;
  double x_m = 0.6;
  for (int k = 0; k < slot; ++k) x_m += 0.6 + 0.8 + 0.1 * (k % 3);
  x_m += 0.5 * (0.8 + 0.1 * (slot % 3));
  const Pose in_slot{x_m, draw(0.75, 1.2), looks_out ? 0.5 * kPi : -0.5 * kPi};
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

/// By the index: out of a dead end, nose first in it, to a place with a heading or without; into one, to look
/// out of it; into one and away again.
void draw_dead_end(MissionRequest& mission, const World& world, Draw& draw, unsigned index) {
  const std::size_t which = (index / 4) % kDeadEnds_m.size();
  double x_m = kBetweenDeadEnds_m;
  for (std::size_t k = 0; k < which; ++k) x_m += kDeadEnds_m[k] + kBetweenDeadEnds_m;
  const Pose inside{x_m + 0.5 * kDeadEnds_m[which], draw(1.0, 2.2), -0.5 * kPi};
  Point2 place_m = free_place(world, draw);
  while (place_m[1] < 4) place_m = free_place(world, draw);
  const double heading_rad = draw.angle_rad();
  mission.start.pose = index % 4 < 2 ? inside : Pose{place_m[0], place_m[1], heading_rad};
  if (index % 4 == 2) add_leg(mission, {inside.x_m, inside.y_m}, 0.5 * kPi);
  if (index % 4 == 3) add_leg(mission, {inside.x_m, inside.y_m}, std::nullopt);
  if (index % 4 == 3) place_m = {draw(1, 9), draw(4.5, 7)};
  if (index % 4 != 2) add_leg(mission, place_m, index % 4 == 1 ? std::optional(heading_rad) : std::nullopt);
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
  static const std::vector<std::string> kinds{"open",  "corner",   "docking", "obstacles",
                                              "stops", "dead_end", "behind",  "docking_back"};
  return kinds;
}

JointFloors::JointFloors() {
  worlds_.push_back(world_of("empty", free_grid(600, 600, kCell_m)));
  worlds_.push_back(world_of("docks", docks()));
  worlds_.push_back(world_of("rooms", rooms()));
  worlds_.push_back(world_of("dead ends", dead_ends(), long_robot()));
}

const World& JointFloors::of(const std::string& kind) const {
  if (kind == "docking" || kind == "docking_back") return worlds_[1];
  if (kind == "dead_end") return worlds_[3];
  return kind == "obstacles" || kind == "stops" ? worlds_[2] : worlds_[0];
}

JointCase joint_case(const JointFloors& floors, const std::string& kind, unsigned seed, unsigned index) {
  JointCase one{.name = kind + " " + std::to_string(index), .world = &floors.of(kind)};
  one.mission.name = kind;
  one.mission.clearance_m = kJointClearance_m;
  Draw draw(seed, kind, index);
  if (kind == "open") draw_open(one.mission, draw, index, 0.7, 10, 0);
  if (kind == "corner") draw_open(one.mission, draw, index, 0.3, 2, 0.75 * kPi);
  if (kind == "behind") draw_behind(one.mission, draw);
  if (kind == "docking") draw_docking(one.mission, *one.world, draw, index, (index / 12) % 2 == 1);
  if (kind == "docking_back") draw_docking(one.mission, *one.world, draw, index, index % 2 == 0);
  if (kind == "dead_end") draw_dead_end(one.mission, *one.world, draw, index);
  if (kind == "obstacles") draw_places(one.mission, *one.world, draw, index, 1);
  if (kind == "stops") draw_places(one.mission, *one.world, draw, index, 2);
  return one;
}

}  // namespace joulepath::ways
