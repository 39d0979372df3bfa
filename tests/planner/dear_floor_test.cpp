#include <gtest/gtest.h>

#include <random>

#include "planner/mission/mission.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Edges of a rectangle, m.
struct Box {
  double x0{}, x1{}, y0{}, y1{};
};

constexpr double kSide_m = 14, kCell_m = 0.1;

/// A floor of 14 m x 14 m about (5, 0) whose cells in boxes have a value.
OccupancyGrid floor_with(const std::vector<Box>& boxes, std::int8_t value) {
  constexpr int kCells = static_cast<int>(kSide_m / kCell_m);
  OccupancyGrid grid = free_grid(kCells, kCells, kCell_m);
  grid.origin = {-2, -7, 0};
  for (std::size_t i = 0; i < grid.occupancy_percent.size(); ++i) {
    const auto [x, y] = grid.center_of(grid.cell_at(i));
    for (const Box& box : boxes)
      if (x > box.x0 && x < box.x1 && y > box.y0 && y < box.y1) grid.occupancy_percent[i] = value;
  }
  return grid;
}

MissionRequest out_and_on(double stop_y_m) {
  MissionRequest mission{.name = "past the boxes", .clearance_m = 0.05};
  mission.stations = {{"a", {.x_m = 10, .y_m = 0}}, {"b", {.x_m = 10.5, .y_m = stop_y_m}}};
  mission.start = {.pose = {0, 0, 0}};
  mission.legs = {{.to = "a"}, {.to = "b"}};
  return mission;
}

const PlanOptions kSmallPlan{.solver = SolverChoice::fast, .nodes = 80, .accuracy = 1e-3, .baselines = false};

double cost_of(const MissionRequest& mission, const MissionWorld& world) {
  const Plan plan = plan_mission(mission, world, kSmallPlan);
  if (!is_driven(plan)) return kNoLimit;
  return mission.objective.minimize == Objective::Minimize::time ? plan.duration_s : plan.energy.total_J();
}

/// One or two boxes across the way to the first stop.
std::vector<Box> boxes_on_the_way(std::mt19937& random) {
  std::uniform_real_distribution<> edge(0.3, 2.5), share(0, 1);
  std::vector<Box> boxes{{2.5, 2.5 + edge(random), -edge(random), edge(random)}};
  if (share(random) < 0.5) boxes.push_back({6, 6 + edge(random), -edge(random), edge(random)});
  return boxes;
}

/// A wall where a speed mask is slow makes a harder problem.
TEST(DearFloor, APlanIsNoDearerThanWithAWallWhereAMaskIsSlow) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 4; ++trial) {
    const std::vector<Box> boxes = boxes_on_the_way(random);
    const auto slow_percent = static_cast<std::int8_t>(trial % 2 == 0 ? 70 : 45);
    MissionRequest mission = out_and_on(trial - 3);
    if (trial % 3 == 2) mission.objective.minimize = Objective::Minimize::time;
    const MissionWorld slow{.robot = testing::nomad(),
                            .map = floor_with({}, 0),
                            .speed_mask = SpeedMask{.grid = floor_with(boxes, slow_percent)}};
    const MissionWorld walled{.robot = testing::nomad(), .map = floor_with(boxes, 100)};
    EXPECT_LE(cost_of(mission, slow), 1.001 * cost_of(mission, walled)) << trial;
  }
}

/// The same with patches of rolling resistance.
TEST(DearFloor, APlanIsNoDearerThanWithAWallWhereAPatchRollsBadly) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 2; ++trial) {
    const Box box = boxes_on_the_way(random).front();
    Robot rough = testing::nomad();
    rough.effects = {{.name = "floor_patch",
                      .parameters = {{"coefficient", trial % 2 == 0 ? 0.1 : 0.03}},
                      .cells = {{box.x0, box.x1, box.y0, box.y1}}}};
    const MissionRequest mission = out_and_on(2 - trial);
    EXPECT_LE(cost_of(mission, {.robot = rough, .map = floor_with({}, 0)}),
              1.001 * cost_of(mission, {.robot = rough, .map = floor_with({box}, 100)}))
        << trial;
  }
}

/// A part that holds a stop is not closed, and one that spans the floor leaves a way through it.
TEST(DearFloor, SlowPartsThatCannotBeAvoidedAreDriven) {
  const std::vector<Box> across{{3, 4, -8, 8}}, about_the_stop{{9, 11, -1, 1}};
  for (const std::vector<Box>& boxes : {across, about_the_stop}) {
    const MissionWorld slow{.robot = testing::nomad(),
                            .map = floor_with({}, 0),
                            .speed_mask = SpeedMask{.grid = floor_with(boxes, 60)}};
    const double cost_J = cost_of(out_and_on(3), slow);
    EXPECT_LT(cost_J, kNoLimit);
    EXPECT_GT(cost_J, cost_of(out_and_on(3), {.robot = testing::nomad(), .map = floor_with({}, 0)}));
  }
}

}  // namespace
}  // namespace joulepath
