#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "benchmarks/ways/joint_cases.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;
const PlanOptions kOnFloor{.solver = SolverChoice::fast, .nodes = 100, .accuracy = 1e-3, .baselines = false};

/// Both motors alike: what is mirrored, or driven the other way round, costs the same.
Robot even_robot() {
  Robot robot = testing::nomad();
  robot.motor.left = robot.motor.right;
  return robot;
}

Robot that_reverses(Robot robot, double speed_m_s = 1) {
  robot.limits->reverse_speed_m_s = speed_m_s;
  return robot;
}

MissionRequest leg_on_a_floor(const Pose& start, const Pose& goal) {
  MissionRequest mission{.name = "pose", .clearance_m = 0.05};
  mission.stations["goal"] = {.x_m = goal.x_m, .y_m = goal.y_m, .heading_rad = goal.heading_rad};
  mission.start.pose = start;
  mission.legs = {{.to = "goal"}};
  return mission;
}

Plan plan_on_floor(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot, .map = free_grid(400, 300, 0.05)}, kOnFloor);
}

/// The sign of travel of each piece of a plan.
std::vector<int> signs(const Plan& plan) {
  std::vector<int> signs;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) signs.push_back(travel_sign(stretch.request.piece));
  return signs;
}

/// A leg of 0.3 to 3 m about the middle of the floor.
MissionRequest drawn_leg(std::mt19937& random) {
  std::uniform_real_distribution<> angle(-kHalfTurn_rad, kHalfTurn_rad), reach(0.3, 3);
  const double start_rad = angle(random), bearing_rad = angle(random), reach_m = reach(random),
               heading_rad = angle(random);
  return leg_on_a_floor({10, 7, start_rad}, {10 + reach_m * std::cos(bearing_rad),
                                             7 + reach_m * std::sin(bearing_rad), heading_rad});
}

Robot of_case(const ways::JointCase& one, bool backward) {
  return backward ? that_reverses(one.world->world.robot) : one.world->world.robot;
}

Plan plan_case(const ways::JointCase& one, bool backward) {
  return plan_mission(one.mission, {.robot = of_case(one, backward), .map = one.world->world.map}, kOnFloor);
}

TEST(Reverse, AGoalBehindCostsWhatOneAheadCosts) {
  for (const double reach_m : {1.0, 3.0, 6.0, 10.0}) {
    const Plan behind =
        plan_on_floor(leg_on_a_floor({14, 7, 0}, {14 - reach_m, 7, 0}), that_reverses(even_robot()));
    const Plan ahead = plan_on_floor(leg_on_a_floor({4, 7, 0}, {4 + reach_m, 7, 0}), even_robot());
    EXPECT_EQ(signs(behind), std::vector<int>{-1}) << reach_m;
    EXPECT_NEAR(behind.energy.total_J() / ahead.energy.total_J(), 1, 1e-3) << reach_m;
  }
}

TEST(Reverse, ARobotWithoutASpeedForItNeverDrivesBackward) {
  for (const int sign : signs(plan_on_floor(leg_on_a_floor({14, 7, 0}, {13, 7, 0}), even_robot())))
    EXPECT_GE(sign, 0);
}

TEST(Reverse, TheLegsDirectionBindsTheSearch) {
  MissionRequest mission = leg_on_a_floor({14, 7, 0}, {11, 7, 0});
  mission.legs.front().direction = LegDirection::forward;
  for (const int sign : signs(plan_on_floor(mission, that_reverses(even_robot())))) EXPECT_GE(sign, 0);
  mission = leg_on_a_floor({4, 7, 0}, {8, 7, 0});
  mission.legs.front().direction = LegDirection::reverse;
  for (const int sign : signs(plan_on_floor(mission, that_reverses(even_robot())))) EXPECT_EQ(sign, -1);
  EXPECT_THROW((void)plan_on_floor(mission, even_robot()), ConfigError);
}

TEST(Reverse, ItsSpeedIsALimitOfItsOwn) {
  const Plan plan = plan_on_floor(leg_on_a_floor({14, 7, 0}, {8, 7, 0}), that_reverses(even_robot(), 0.7));
  ASSERT_EQ(signs(plan), std::vector<int>{-1});
  const std::vector<double>& rate = plan.legs[0].stretches[0].profile.rate;
  EXPECT_LE(*std::max_element(rate.begin(), rate.end()), 0.7 * (1 + 1e-9));
}

// `acceleration_m_s2` limits how fast |v| grows, `deceleration_m_s2` how fast it falls.
TEST(Reverse, AccelerationAndDecelerationAreOfTheSpeedsMagnitude) {
  Robot robot = that_reverses(even_robot());
  robot.limits->acceleration_m_s2 = 0.2;
  robot.limits->deceleration_m_s2 = 0.9;
  MissionRequest mission = leg_on_a_floor({14, 7, 0}, {10, 7, 0});
  mission.objective.minimize = Objective::Minimize::time;
  const Plan plan = plan_on_floor(mission, robot);
  ASSERT_EQ(signs(plan), std::vector<int>{-1});
  const Trajectory motion = plan_trajectory(plan, make_nominal_plant(robot));
  const auto [slowest, fastest] =
      std::minmax_element(motion.linear_acceleration_m_s2.begin(), motion.linear_acceleration_m_s2.end());
  EXPECT_NEAR(*slowest, -0.2, 1e-3);  // v falls from 0 to -1 m/s: its magnitude grows
  EXPECT_NEAR(*fastest, 0.9, 1e-3);
}

// What a follower, a simulator or a diagnosis reads: v is negative, the heading is the robot's.
TEST(Reverse, ItsTrajectoryHasANegativeSpeedAndTheRobotsHeading) {
  const Robot robot = that_reverses(even_robot());
  const Plan plan = plan_on_floor(leg_on_a_floor({10, 7, 0.4}, {8, 6.6, 0.1}), robot);
  const std::vector<int> driven = signs(plan);
  ASSERT_TRUE(std::count(driven.begin(), driven.end(), -1) > 0);
  const Trajectory motion = plan_trajectory(plan, make_nominal_plant(robot), 100);
  EXPECT_NEAR(motion.heading_rad.front(), 0.4, 1e-9);
  EXPECT_NEAR(std::remainder(motion.heading_rad.back() - 0.1, 2 * kHalfTurn_rad), 0, 1e-6);
  double backward_s = 0;
  for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
    const double step_s = motion.time_s[k + 1] - motion.time_s[k];
    const double speed_m_s = 0.5 * (motion.linear_speed_m_s[k] + motion.linear_speed_m_s[k + 1]),
                 heading_rad = 0.5 * (motion.heading_rad[k] + motion.heading_rad[k + 1]);
    EXPECT_NEAR(motion.position_x_m[k + 1] - motion.position_x_m[k],
                speed_m_s * std::cos(heading_rad) * step_s, 2e-4);
    EXPECT_NEAR(motion.position_y_m[k + 1] - motion.position_y_m[k],
                speed_m_s * std::sin(heading_rad) * step_s, 2e-4);
    if (speed_m_s < 0) backward_s += step_s;
  }
  EXPECT_GT(backward_s, 1);
}

TEST(Reverse, IsNeverDearerThanForwardOnly) {
  std::mt19937 random(8);
  double saved = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const MissionRequest mission = drawn_leg(random);
    const double forward_J = plan_on_floor(mission, even_robot()).energy.total_J();
    const double any_J = plan_on_floor(mission, that_reverses(even_robot())).energy.total_J();
    EXPECT_LE(any_J, forward_J * (1 + 1e-6)) << trial;
    saved = std::max(saved, 1 - any_J / forward_J);
  }
  EXPECT_GT(saved, 0.1);
}

// The floor reaches from 0 to 20 m and from 0 to 15 m.
TEST(Reverse, AMirroredLegGetsTheMirroredPlan) {
  std::mt19937 random(21);
  for (int trial = 0; trial < 5; ++trial) {
    const MissionRequest mission = drawn_leg(random);
    MissionRequest mirrored = mission;
    mirrored.start.pose = {10, 8, -mission.start.pose.heading_rad};
    Station& goal = mirrored.stations.at("goal");
    goal.y_m = 15 - goal.y_m;
    *goal.heading_rad *= -1;
    const Plan plan = plan_on_floor(mission, that_reverses(even_robot())),
               image = plan_on_floor(mirrored, that_reverses(even_robot()));
    EXPECT_NEAR(image.energy.total_J() / plan.energy.total_J(), 1, 1e-3) << trial;
    EXPECT_EQ(signs(image), signs(plan)) << trial;
  }
}

// To a robot that is alike in both directions its front is a name. The searches are local, and more of their
// starts drive forward, so that the plans may differ a little.
TEST(Reverse, ALegOfTheRobotTurnedRoundCostsTheSame) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 5; ++trial) {
    const MissionRequest mission = drawn_leg(random);
    MissionRequest turned = mission;
    turned.start.pose.heading_rad += kHalfTurn_rad;
    *turned.stations.at("goal").heading_rad += kHalfTurn_rad;
    EXPECT_NEAR(plan_on_floor(turned, that_reverses(even_robot())).energy.total_J() /
                    plan_on_floor(mission, that_reverses(even_robot())).energy.total_J(),
                1, 5e-3)
        << trial;
  }
}

// Cases of the generator in benchmarks/ways; the robot has no room to turn in a dead end.
TEST(Reverse, LeavesAndEntersDeadEnds) {
  const ways::JointFloors floors;
  for (const unsigned index : {0U, 2U}) {
    const ways::JointCase one = joint_case(floors, "dead_end", 3, index);
    const Plan plan = plan_case(one, true);
    ASSERT_FALSE(plan.infeasibility) << one.name << ": " << plan.infeasibility->reason.message;
    const std::vector<int> driven = signs(plan);
    EXPECT_GT(std::count(driven.begin(), driven.end(), -1), 0) << one.name;
  }
}

TEST(Reverse, TheVerdictOfADeadEndNamesTheKeyOfTheRobotFile) {
  const ways::JointFloors floors;
  const Plan stuck = plan_case(joint_case(floors, "dead_end", 3, 0), false);
  ASSERT_TRUE(stuck.infeasibility);
  EXPECT_NE(stuck.infeasibility->reason.message.find("limits: {reverse_speed_m_s"), std::string::npos)
      << stuck.infeasibility->reason.message;
}

TEST(Reverse, NoDockingIsDearerThanForwardOnly) {
  const ways::JointFloors floors;
  for (const unsigned index : {1U, 2U, 3U}) {
    const ways::JointCase one = joint_case(floors, "docking", 3, index);
    EXPECT_LE(plan_case(one, true).energy.total_J(), plan_case(one, false).energy.total_J() * (1 + 1e-6))
        << one.name;
  }
}

TEST(Reverse, TheVerdictOfAForwardLegNamesItsDirection) {
  const ways::JointFloors floors;
  ways::JointCase one = joint_case(floors, "dead_end", 3, 0);
  one.mission.legs.front().direction = LegDirection::forward;
  const Plan stuck = plan_case(one, true);
  ASSERT_TRUE(stuck.infeasibility);
  EXPECT_NE(stuck.infeasibility->reason.message.find("direction: any"), std::string::npos)
      << stuck.infeasibility->reason.message;
}

// A way that is blocked in both directions is no matter of driving backward.
TEST(Reverse, TheVerdictOfABlockedLegDoesNotNameIt) {
  MissionRequest mission = leg_on_a_floor({2, 2, 0}, {8, 2, 0});
  OccupancyGrid grid = free_grid(200, 80, 0.05);
  for (int row = 0; row < 80; ++row) grid.occupancy_percent[static_cast<std::size_t>(row * 200 + 100)] = 100;
  const Plan stuck = plan_mission(mission, {.robot = even_robot(), .map = grid}, kOnFloor);
  ASSERT_TRUE(stuck.infeasibility);
  EXPECT_EQ(stuck.infeasibility->reason.message.find("reverse"), std::string::npos);
}

}  // namespace
}  // namespace joulepath
