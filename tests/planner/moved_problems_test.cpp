// Laws of the same problem turned, moved and asked otherwise.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "planner/mission/mission.hpp"
#include "planner/path/search/search.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kRight_rad = 0.5 * std::numbers::pi;
const PlanOptions kSearched{.solver = SolverChoice::fast, .baselines = false};
using Boxes = std::vector<std::array<int, 4>>;  ///< first column and row, end of columns and rows

OccupancyGrid floor_of(int width, int height, double resolution_m, const Pose& origin, const Boxes& boxes) {
  OccupancyGrid map = free_grid(width, height, resolution_m);
  map.origin = origin;
  for (const auto& [column, row, end_column, end_row] : boxes)
    for (int i = row; i < end_row; ++i)
      for (int k = column; k < end_column; ++k) map.occupancy_percent[map.index_of({k, i})] = 100;
  return map;
}

/// Walls about a floor.
Boxes walls(int width, int height) {
  return {{0, 0, width, 1}, {0, height - 1, width, height}, {0, 0, 1, height}, {width - 1, 0, width, height}};
}

void set_outline(Robot& robot, double rear_m, double front_m, double half_m) {
  robot.footprint = {0, {{front_m, half_m}, {rear_m, half_m}, {rear_m, -half_m}, {front_m, -half_m}}};
}

Plan planned_on(const OccupancyGrid& map, const Robot& robot, const MissionRequest& mission) {
  return plan_mission(mission, {.robot = robot, .map = map}, kSearched);
}

/// In a room of 5 x 3 m; the axle of the robot is near its rear.
Plan backed_up_to(double goal_x_m) {
  Robot robot = testing::nomad();
  robot.limits->reverse_speed_m_s = 0.4;
  set_outline(robot, -0.15, 0.75, 0.25);
  MissionRequest mission{.name = "back up"};
  mission.start.pose = {2.5, 1.5, 0};
  mission.stations["wall"] = {.x_m = goal_x_m, .y_m = 1.5, .heading_rad = 0.0};
  mission.legs = {{.to = "wall"}};
  return planned_on(floor_of(100, 60, 0.05, {}, walls(100, 60)), robot, mission);
}

// Nose first it would not fit there; at 0.81 m the disc about it touches the wall.
TEST(MovedGoal, BehindTheRobotIsReachedAsFarAsItsRearFits) {
  double nearer_J = 0;
  for (const double goal_x_m : {0.9, 0.81, 0.3}) {
    const Plan plan = backed_up_to(goal_x_m);
    ASSERT_LE(plan.status, SolveStatus::feasible) << goal_x_m << ": " << plan.message;
    EXPECT_NEAR(plan.legs[0].distance_m, 2.5 - goal_x_m, 1e-3);
    EXPECT_GT(plan.energy.total_J(), nearer_J) << goal_x_m;
    nearer_J = plan.energy.total_J();
  }
  EXPECT_EQ(backed_up_to(0.18).status, SolveStatus::infeasible);  // the wall's face is at 0.05 m
}

// OMPL would wait for another goal.
TEST(MovedGoal, WithoutRoomEndsTheSearch) {
  const ObstacleField field(floor_of(100, 60, 0.05, {}, walls(100, 60)), nullptr);
  const FreeSpace space(field, 0.5);
  SearchRequest request{.start_m = {2.5, 1.5}, .goal_m = {0.54, 1.5}};
  EXPECT_TRUE(search_polyline(space, request).polyline_m.empty());
  request.goal_m = {1.0, 1.5};
  EXPECT_FALSE(search_polyline(space, request).polyline_m.empty());
}

/// A robot of 0.5 kg among boxes.
Robot tiny() {
  Robot robot = testing::nomad();
  robot.geometry = {.wheel_radius_m = {0.02, 0.02}, .half_track_m = 0.05, .center_of_mass_offset_m = 0.005};
  robot.inertia = {.chassis_mass_kg = 0.5,
                   .wheel_mass_kg = 0.02,
                   .chassis_yaw_inertia_kg_m2 = 0.001,
                   .payload_yaw_inertia_m2 = 0.002,
                   .wheel_axle_inertia_kg_m2 = 2e-5,
                   .wheel_diameter_inertia_kg_m2 = 2e-6};
  const Motor motor{.gear_ratio = 50,
                    .resistance_ohm = 8,
                    .torque_constant_Nm_A = 0.006,
                    .voltage_constant_V_s_rad = 0.006,
                    .viscous_friction_Nm_s_rad = 1e-4,
                    .friction_torque_Nm = 0.01,
                    .max_voltage_V = 6,
                    .max_current_A = 0.5};
  robot.motor = {motor, motor};
  robot.limits->speed_m_s = 0.3, robot.limits->reverse_speed_m_s = 0.2;
  robot.limits->deceleration_m_s2 = 0.6;
  robot.limits->yaw_rate_rad_s = 4, robot.limits->yaw_acceleration_rad_s2 = 20;
  robot.power = {.standby_W = 0.5};
  set_outline(robot, -0.05, 0.08, 0.06);
  return robot;
}

/// About the origin by right angles.
Pose turned(const Pose& pose, int quarters) {
  const double c = std::cos(quarters * kRight_rad), s = std::sin(quarters * kRight_rad);
  return {c * pose.x_m - s * pose.y_m, s * pose.x_m + c * pose.y_m, pose.heading_rad + quarters * kRight_rad};
}

// The map is the same image about a turned origin. A start of the search that has not converged goes on
// where no path came of any: without that, one of these legs costs half as much again.
TEST(TurnedLeg, CostsWhatItCostsUnturned) {
  Boxes boxes{{27, 1, 28, 10},  {27, 22, 28, 55}, {44, 27, 50, 32}, {1, 33, 16, 34},
              {45, 38, 46, 46}, {1, 45, 16, 46},  {1, 54, 27, 55},  {28, 54, 58, 55}};
  for (const auto& wall : walls(59, 55)) boxes.push_back(wall);
  double first_J = 0;
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Pose goal = turned({0.2317, 2.0211, 0}, quarters);
    MissionRequest mission{.name = "turned"};
    mission.start.pose = turned({-0.6054, 1.4982, kRight_rad}, quarters);
    mission.stations["goal"] = {.x_m = goal.x_m, .y_m = goal.y_m, .heading_rad = goal.heading_rad};
    mission.legs = {{.to = "goal"}};
    const Plan plan =
        planned_on(floor_of(59, 55, 0.025, turned({-1.05, 0.99, 0}, quarters), boxes), tiny(), mission);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    if (quarters == 0) first_J = plan.energy.total_J();
    EXPECT_NEAR(plan.energy.total_J() / first_J, 1, 0.05) << quarters;
  }
}

/// A robot of 1 t.
Robot ton() {
  Robot robot = testing::nomad();
  robot.geometry = {.wheel_radius_m = {0.15, 0.15}, .half_track_m = 0.4, .center_of_mass_offset_m = 0.1};
  robot.inertia = {.chassis_mass_kg = 1000,
                   .wheel_mass_kg = 12,
                   .chassis_yaw_inertia_kg_m2 = 300,
                   .payload_yaw_inertia_m2 = 0.2,
                   .wheel_axle_inertia_kg_m2 = 0.5,
                   .wheel_diameter_inertia_kg_m2 = 0.1};
  const Motor motor{.gear_ratio = 30,
                    .resistance_ohm = 0.1,
                    .torque_constant_Nm_A = 0.15,
                    .voltage_constant_V_s_rad = 0.15,
                    .viscous_friction_Nm_s_rad = 0.2,
                    .friction_torque_Nm = 12,
                    .max_voltage_V = 48,
                    .max_current_A = 60};
  robot.motor = {motor, motor};
  robot.limits = Limits{.speed_m_s = 1.2,
                        .acceleration_m_s2 = 0.3,
                        .deceleration_m_s2 = 0.3,
                        .lateral_acceleration_m_s2 = 0.5,
                        .yaw_rate_rad_s = 0.6,
                        .yaw_acceleration_rad_s2 = 0.5,
                        .traction_coefficient = 0.6};
  robot.power = {.standby_W = 100, .regeneration_efficiency = 0.6, .sharing = PowerSharing::bus};
  robot.battery = {};
  set_outline(robot, -0.5, 0.8, 0.45);
  return robot;
}

// Where two legs together lead nowhere, each is optimized alone. The searches are local.
TEST(FreeHeading, OfAStopIsNoDearerThanAPrescribedOne) {
  Boxes boxes{{93, 1, 95, 112}, {154, 53, 176, 62}, {1, 78, 50, 80}, {1, 114, 50, 116}, {93, 147, 95, 166}};
  for (const auto& wall : walls(220, 166)) boxes.push_back(wall);
  for (const Pose& origin : {Pose{103.89, 7.84, 0}, Pose{104.26, 11.61, 0}}) {
    const OccupancyGrid map = floor_of(220, 166, 0.07343023900274329, origin, boxes);
    MissionRequest mission{.name = "two legs"};
    mission.start.pose = {origin.x_m + 14.2021, origin.y_m + 3.8603, 0};
    mission.stations["s1"] = {.x_m = origin.x_m + 8.4336, .y_m = origin.y_m + 7.6615};
    mission.stations["s2"] = {
        .x_m = origin.x_m + 3.2759, .y_m = origin.y_m + 7.2948, .heading_rad = -kRight_rad};
    mission.legs = {{.to = "s1"}, {.to = "s2"}};
    const Plan free = planned_on(map, ton(), mission);
    mission.stations["s1"].heading_rad = 2.3779;
    const Plan prescribed = planned_on(map, ton(), mission);
    ASSERT_LE(free.status, SolveStatus::feasible) << free.message;
    ASSERT_LE(prescribed.status, SolveStatus::feasible) << prescribed.message;
    EXPECT_LE(free.energy.total_J(), 1.05 * prescribed.energy.total_J());
  }
}

}  // namespace
}  // namespace joulepath
