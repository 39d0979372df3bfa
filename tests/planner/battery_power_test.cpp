#include "model/battery_power.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// 9 m straight, then the corner of the paper's curve.
MissionRequest line_and_curve() {
  MissionRequest mission{.name = "line_and_curve"};
  mission.legs = {
      {.path = PathRequest{.bezier_m = {{{{0, 0}, {3, 0}, {6, 0}, {9, 0}}}}}, .payload = {8, 8}},
      {.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}}, .payload = {2, 2}}};
  return mission;
}

Robot robot_with(double resistance_ohm, double standby_W = 10.0) {
  Robot robot = testing::nomad();
  robot.battery.internal_resistance_ohm = resistance_ohm;
  robot.power.standby_W = standby_W;
  return robot;
}

Plan supplied_plan(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
}

/// The largest power (W) at the battery's terminals.
double most_power_W(const Plan& plan, const Robot& robot) {
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 200.0);
  return *std::max_element(rows.battery_power_W.begin(), rows.battery_power_W.end());
}

/// What holds for every answer: a plan takes what the battery has and pays for its resistance, a verdict
/// names the battery and a resistance with which there is a plan.
void expect_supplied(const MissionRequest& mission, const Robot& robot) {
  const Plan plan = supplied_plan(mission, robot);
  const double most_W = most_battery_power_W(robot.battery);
  if (plan.status <= SolveStatus::feasible) {
    EXPECT_LE(most_power_W(plan, robot), most_W);
    ASSERT_TRUE(plan.battery.has_value());
    EXPECT_GT(plan.battery->loss_J, 0.0);
    EXPECT_LT(plan.battery->lowest_voltage_V, robot.battery.open_circuit_voltage_V);
    EXPECT_GE(plan.battery->lowest_voltage_V, 0.5 * robot.battery.open_circuit_voltage_V);
    return;
  }
  ASSERT_TRUE(plan.infeasibility.has_value()) << plan.message;
  EXPECT_EQ(plan.infeasibility->reason.constraint, "battery_power") << plan.message;
  const auto& relaxation = plan.infeasibility->reason.relaxation;
  ASSERT_TRUE(relaxation.contains("internal_resistance_ohm")) << plan.message;
  Robot better = robot;
  better.battery.internal_resistance_ohm = relaxation.at("internal_resistance_ohm");
  EXPECT_LT(better.battery.internal_resistance_ohm, robot.battery.internal_resistance_ohm);
  EXPECT_LE(supplied_plan(mission, better).status, SolveStatus::feasible)
      << supplied_plan(mission, better).message;
  better.battery.internal_resistance_ohm *= 1.15;
  EXPECT_EQ(supplied_plan(mission, better).status, SolveStatus::infeasible) << "a smaller change works";
}

TEST(BatteryPower, NoPlanTakesMoreThanTheBatterySupplies) {
  for (const double resistance_ohm : {0.05, 1.5, 3.0, 5.0, 8.0, 50.0}) {
    SCOPED_TRACE(resistance_ohm);
    expect_supplied(line_and_curve(), robot_with(resistance_ohm));
  }
}

TEST(BatteryPower, StandbyBeyondTheBatteryIsRefusedWithAResistanceThatWorks) {
  Robot robot = robot_with(0.05, 10'000.0);
  robot.battery.capacity_Wh = 1e6;
  expect_supplied(line_and_curve(), robot);
}

/// Standby that the battery cannot supply fails where the drive begins.
TEST(BatteryPower, StandbyBeyondTheBatteryFailsAtTheStart) {
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = 0.9, motion.distance_m = 4, motion.acceleration_m_s2 = 0.45;
  MissionRequest prescribed{.name = "prescribed", .legs = {{.motion = motion}}};
  MissionRequest stand{.name = "stand", .legs = {{.path = PathRequest{.ready = Path{}}, .dwell_s = 5}}};
  for (MissionRequest mission : {line_and_curve(), prescribed, stand}) {
    mission.start.pose = {3, -2, 0.7};
    for (const auto& [resistance_ohm, standby_W] : {std::pair{0.05, 5e3}, {0.05, 1e4}, {20.0, 10.0}}) {
      const Plan plan = supplied_plan(mission, robot_with(resistance_ohm, standby_W));
      ASSERT_TRUE(plan.infeasibility) << mission.name;
      EXPECT_EQ(plan.infeasibility->leg, 0u) << plan.message;
      EXPECT_EQ(plan.infeasibility->arc_length_m, 0.0) << plan.message;
      EXPECT_NEAR(plan.infeasibility->reason.x_m, 3, 1e-9) << plan.message;
      EXPECT_NEAR(plan.infeasibility->reason.y_m, -2, 1e-9) << plan.message;
    }
  }
}

TEST(BatteryPower, AWeakBatteryMakesTheDriveSlower) {
  const Plan strong = supplied_plan(line_and_curve(), robot_with(0.05)),
             weak = supplied_plan(line_and_curve(), robot_with(5.0));
  ASSERT_LE(weak.status, SolveStatus::feasible) << weak.message;
  EXPECT_GT(most_power_W(strong, robot_with(0.05)), most_battery_power_W(robot_with(5.0).battery));
  EXPECT_GT(weak.duration_s, strong.duration_s);
}

TEST(BatteryPower, APrescribedMotionBeyondTheBatteryIsRefusedAtItsPlace) {
  MissionRequest mission{.name = "prescribed"};
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = 0.9, motion.distance_m = 4, motion.acceleration_m_s2 = 0.45;
  mission.legs = {{.motion = motion, .payload = {8, 8}}};
  const Robot robot = robot_with(5.0);
  expect_supplied(mission, robot);
  const Plan plan = supplied_plan(mission, robot);
  ASSERT_TRUE(plan.infeasibility.has_value());
  EXPECT_GT(plan.infeasibility->arc_length_m, 0.0);
  EXPECT_NE(plan.message.find(" at t = "), std::string::npos) << plan.message;
}

TEST(BatteryPower, AStatedLimitThatIsLowerIsNotBlamedOnTheBattery) {
  Robot robot = robot_with(0.05);
  robot.limits->battery_power_W = 9.0;  // below standby
  const Plan plan = supplied_plan(line_and_curve(), robot);
  ASSERT_TRUE(plan.infeasibility.has_value());
  EXPECT_TRUE(plan.infeasibility->reason.relaxation.contains("battery_power_W")) << plan.message;
}

/// The limit that the robot file states for the leg's payload counts, not the one of the empty robot.
TEST(BatteryPower, TheLimitForThePayloadIsTheOneThatIsBlamed) {
  Robot robot = robot_with(3.0);  // 52 W
  ASSERT_GT(most_battery_power_W(robot.battery), 9.0);
  robot.limits->battery_power_W = 200;
  robot.limits_by_payload = {{.payload_kg = 0, .limit_by_key = {{"battery_power_W", 200}}},
                             {.payload_kg = 8, .limit_by_key = {{"battery_power_W", 9}}}};
  const Plan plan = supplied_plan(line_and_curve(), robot);
  ASSERT_TRUE(plan.infeasibility.has_value());
  EXPECT_TRUE(plan.infeasibility->reason.relaxation.contains("battery_power_W")) << plan.message;
  EXPECT_EQ(plan.message.find("the battery supplies"), std::string::npos) << plan.message;
}

}  // namespace
}  // namespace joulepath
