// A prescribed motion that exceeds a limit is infeasible, whichever limit it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "model/limit_table.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The Nomad without a limit.
Robot unlimited() {
  Robot robot = testing::nomad();
  robot.limits = Limits{};
  for (const Side side : kSides) robot.motor[side].max_current_A = robot.motor[side].max_voltage_V = kNoLimit;
  return robot;
}

Robot with_limit(const Limit& row, double value) {
  Robot robot = unlimited();
  if (row.field != nullptr)
    (*robot.limits).*row.field = value;
  else
    for (const Side side : kSides) robot.motor[side].*row.rating = value;
  return robot;
}

/// To the left on a circle of 2 m radius: 0.4 m/s^2 up to 0.5 m/s, 0.3 m/s^2 down.
PrescribedMotion arc() {
  return {.profile = MotionProfile::arc,
          .acceleration_m_s2 = 0.4,
          .deceleration_m_s2 = 0.3,
          .speed_m_s = 0.5,
          .radius_m = 2,
          .angle_rad = 1.5};
}

PrescribedMotion trapezoid() {
  return {.profile = MotionProfile::trapezoid, .acceleration_m_s2 = 0.25, .speed_m_s = 0.5, .distance_m = 5};
}

MissionRequest mission_of(const PrescribedMotion& motion, double payload_kg = 3) {
  return {.name = "prescribed", .legs = {{.motion = motion, .payload = {payload_kg, payload_kg}}}};
}

Plan planned(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot}, {.solver = SolverChoice::fast, .nodes = 60});
}

const Infeasibility* verdict_of(const Plan& plan) {
  return plan.infeasibility ? &plan.infeasibility->reason : nullptr;
}

TEST(PrescribedLimits, WithoutALimitTheMotionIsPlanned) {
  EXPECT_EQ(verdict_of(planned(mission_of(arc()), unlimited())), nullptr);
}

/// The arc itself, backward for the row that limits driving backward.
MissionRequest mission_for(const Limit& row) {
  PrescribedMotion motion = arc();
  motion.reverse = row.name == "reverse_speed";
  return mission_of(motion);
}

/// The value that the verdict offers is the one that the motion uses: a little more is enough, a tenth less
/// is exceeded by that tenth.
TEST(PrescribedLimits, EveryRowOfTheTableIsHeld) {
  for (const Limit& row : kLimits) {
    if (row.value == nullptr || row.name == "jerk") continue;
    if (row.name == "charge_power" || row.name == "battery_voltage") continue;  // battery_charge_test.cpp
    const Plan hopeless = planned(mission_for(row), with_limit(row, 1e-3));
    ASSERT_NE(verdict_of(hopeless), nullptr) << row.name << " is not held";
    EXPECT_EQ(verdict_of(hopeless)->constraint, row.name);
    ASSERT_EQ(verdict_of(hopeless)->relaxation.count(std::string(row.key)), 1u) << row.name;
    const double used = verdict_of(hopeless)->relaxation.at(std::string(row.key));
    EXPECT_EQ(verdict_of(planned(mission_for(row), with_limit(row, used * 1.0001))), nullptr) << row.name;

    const Plan tight = planned(mission_for(row), with_limit(row, 0.9 * used));
    ASSERT_NE(verdict_of(tight), nullptr) << row.name;
    EXPECT_EQ(tight.status, SolveStatus::infeasible);
    EXPECT_NEAR(verdict_of(tight)->amount, 0.1 * used, 1e-9 * used) << row.name;
    EXPECT_EQ(verdict_of(tight)->unit, row.unit);
    EXPECT_NE(tight.message.find("t = "), std::string::npos) << tight.message;
    EXPECT_NE(tight.message.find(row.key), std::string::npos) << tight.message;
  }
}

/// Kinematic limits by hand.
TEST(PrescribedLimits, TheExcessFollowsFromTheMotion) {
  const std::map<std::string, double> expected{{"speed", 0.5},
                                               {"acceleration", 0.4},
                                               {"deceleration", 0.3},
                                               {"lateral_acceleration", 0.5 * 0.5 / 2},
                                               {"yaw_rate", 0.5 / 2},
                                               {"yaw_acceleration", 0.4 / 2},
                                               {"wheel_acceleration", (0.4 + 0.165 * 0.4 / 2) / 0.1}};
  for (const bool reverse : {false, true})
    for (const auto& [name, used] : expected) {
      PrescribedMotion motion = arc();
      motion.reverse = reverse;
      const Plan plan = planned(mission_of(motion), with_limit(*limit_named(name), 0.01));
      ASSERT_NE(verdict_of(plan), nullptr) << name;
      EXPECT_NEAR(verdict_of(plan)->amount, used - 0.01, 1e-5 * used)
          << name << (reverse ? " in reverse" : "");
    }
}

TEST(PrescribedLimits, TheBatteryPowerOfAStraightDriveIsHeld) {
  const Plan plan = planned(mission_of(trapezoid(), 0), with_limit(*limit_named("battery_power"), 12));
  ASSERT_NE(verdict_of(plan), nullptr);
  // At the end of the ramp, by hand: 5 rad/s, tau = 0.7513 and 0.7245 N m, i = 0.4373 and 0.4217 A,
  // R i^2 + Kv n q' i = 4.2805 and 4.1097 W, and 10 W of standby.
  EXPECT_NEAR(verdict_of(plan)->amount, 18.390 - 12, 1e-3) << plan.message;
  EXPECT_NEAR(verdict_of(plan)->s, 0.5, 1e-3);
  EXPECT_NEAR(verdict_of(plan)->x_m, 0.5, 1e-3);
}

/// The curves that a message offers, all numbers of `path: {bezier_m: ...}`.
std::vector<BezierPoints> offered_curves(const std::string& message) {
  const std::size_t from = message.find("bezier_m: "), to = message.find("}`");
  std::vector<double> numbers;
  if (from == std::string::npos || to == std::string::npos) return {};
  std::string text = message.substr(from + 10, to - from - 10);
  std::ranges::replace_if(
      text, [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  std::istringstream in(text);
  for (double number = 0; in >> number;) numbers.push_back(number);
  std::vector<BezierPoints> curves(numbers.size() / 8);
  for (std::size_t i = 0; i < 8 * curves.size(); ++i) curves[i / 8][i % 8 / 2][i % 2] = numbers[i];
  return curves;
}

/// The advice against steps of acceleration, taken literally: it is planned and leads to the same end.
TEST(PrescribedLimits, TheWayOutOfAJumpIsPlannedAndLeadsToTheSameEnd) {
  for (const double limit : {0.05, 0.5})
    for (const double angle_rad : {-4.0, 1.5}) {
      PrescribedMotion turning = arc(), ramps{.profile = MotionProfile::constant_ramp};
      turning.angle_rad = angle_rad;
      ramps.acceleration_m_s2 = 0.3, ramps.ramp_s = 1.5, ramps.distance_m = 3;
      for (const PrescribedMotion& motion : {turning, trapezoid(), ramps}) {
        Robot robot = with_limit(*limit_named("jerk"), limit);
        MissionRequest mission = mission_of(motion);
        const Plan jumps = planned(mission, robot);
        ASSERT_NE(verdict_of(jumps), nullptr);
        const std::vector<BezierPoints> curves = offered_curves(jumps.message);
        ASSERT_FALSE(curves.empty()) << jumps.message;
        mission.legs[0].motion.reset();
        mission.legs[0].path = PathRequest{.bezier_m = curves};
        robot.limits->speed_m_s = 1;
        const Plan smooth = planned(mission, robot);
        ASSERT_LE(smooth.status, SolveStatus::feasible) << smooth.message;
        robot.limits->jerk_m_s3 = kNoLimit;
        const Plan as_prescribed = planned(mission_of(motion), robot);
        ASSERT_EQ(verdict_of(as_prescribed), nullptr) << as_prescribed.message;
        const Trajectory& driven = *as_prescribed.legs[0].prescribed;
        const Pose end = sampled_state(driven, driven.time_s.back()).pose;
        const Trajectory rows = plan_trajectory(smooth, make_plant(robot));
        EXPECT_NEAR(rows.position_x_m.back(), end.x_m, 2e-3);
        EXPECT_NEAR(rows.position_y_m.back(), end.y_m, 2e-3);
      }
    }
}

TEST(PrescribedLimits, NoFiniteJerkLimitAllowsAJumpOfAcceleration) {
  const Robot robot = with_limit(*limit_named("jerk"), 1000);
  for (const PrescribedMotion& motion : {arc(), trapezoid()}) {
    const Plan plan = planned(mission_of(motion), robot);
    ASSERT_NE(verdict_of(plan), nullptr);
    EXPECT_EQ(verdict_of(plan)->constraint, "jerk");
    EXPECT_TRUE(verdict_of(plan)->relaxation.empty());
    EXPECT_NEAR(verdict_of(plan)->amount, *motion.acceleration_m_s2, 1e-4);
    EXPECT_EQ(plan.message.find("inf"), std::string::npos) << plan.message;
    EXPECT_NE(plan.message.find("`path: {bezier_m: [[["), std::string::npos) << plan.message;
  }
  using enum MotionProfile;
  for (const PrescribedMotion& motion :
       {PrescribedMotion{.profile = constant_speed, .speed_m_s = 0.5, .distance_m = 2},
        PrescribedMotion{.profile = spin, .angle_rad = 2, .yaw_rate_rad_s = 1, .yaw_acceleration_rad_s2 = 1},
        PrescribedMotion{.profile = coast, .speed_m_s = 0.5},
        PrescribedMotion{.profile = stand, .duration_s = 2}})
    EXPECT_EQ(verdict_of(planned(mission_of(motion), robot)), nullptr);
}

TEST(PrescribedLimits, ThePayloadIsHeld) {
  const Plan plan = planned(mission_of(arc(), 5), with_limit(*limit_named("max_payload"), 4));
  ASSERT_NE(verdict_of(plan), nullptr);
  EXPECT_EQ(verdict_of(plan)->constraint, "max_payload");
}

TEST(PrescribedLimits, SpeedZonesAreHeldInsideThem) {
  MissionRequest mission = mission_of(trapezoid());
  mission.speed_zones = {{.leg = 0, .from_m = 2, .to_m = 3, .speed_m_s = 0.3}};
  const Plan plan = planned(mission, unlimited());
  ASSERT_NE(verdict_of(plan), nullptr);
  EXPECT_EQ(verdict_of(plan)->constraint, "speed");
  EXPECT_NEAR(verdict_of(plan)->amount, 0.2, 1e-9);
  EXPECT_NEAR(verdict_of(plan)->s, 2, 0.02);
  mission.speed_zones = {{.leg = 0, .from_m = 0, .to_m = 0.08, .speed_m_s = 0.3}};  // 0.2 m/s at its end
  EXPECT_EQ(verdict_of(planned(mission, unlimited())), nullptr);
}

TEST(PrescribedLimits, TwoExceededLimitsAreBothNamedWithoutARelaxation) {
  Robot robot = with_limit(*limit_named("battery_power"), 12);
  robot.limits->speed_m_s = 0.45;
  const Plan plan = planned(mission_of(trapezoid()), robot);
  ASSERT_NE(verdict_of(plan), nullptr);
  EXPECT_EQ(verdict_of(plan)->constraint, "battery_power");
  EXPECT_NE(plan.message.find("speed by 0.05 m/s"), std::string::npos) << plan.message;
  EXPECT_TRUE(verdict_of(plan)->relaxation.empty());
}

/// After a spin to the left, the casters swivel twice as far for a spin to the right as from straight.
TEST(PrescribedLimits, CasterMemoryOfThePreviousLegCounts) {
  const auto spin = [](double angle_rad) {
    return LegRequest{.motion = PrescribedMotion{.profile = MotionProfile::spin,
                                                 .angle_rad = angle_rad,
                                                 .yaw_rate_rad_s = 1,
                                                 .yaw_acceleration_rad_s2 = 1}};
  };
  const auto plan_with = [&](const std::vector<LegRequest>& legs, double battery_power_W) {
    Robot robot = with_limit(*limit_named("battery_power"), battery_power_W);
    robot.effects = {{.name = "caster_swivel", .parameters = {{"moment_Nm", 5}, {"trail_m", 0.3}}}};
    return planned({.name = "spins", .legs = legs}, robot);
  };
  const Plan hopeless = plan_with({spin(3)}, 1e-3);
  ASSERT_NE(verdict_of(hopeless), nullptr);
  const double enough_W = 1.05 * verdict_of(hopeless)->relaxation.at("battery_power_W");
  EXPECT_EQ(verdict_of(plan_with({spin(3)}, enough_W)), nullptr);
  EXPECT_EQ(verdict_of(plan_with({spin(-3)}, enough_W)), nullptr);
  const Plan both = plan_with({spin(3), spin(-3)}, enough_W);
  ASSERT_NE(verdict_of(both), nullptr);
  EXPECT_EQ(verdict_of(both)->constraint, "battery_power");
  EXPECT_EQ(both.infeasibility->leg, 1u);
}

}  // namespace
}  // namespace joulepath
