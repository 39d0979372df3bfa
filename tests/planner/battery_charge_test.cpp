// Batteries with an open-circuit curve: the motors' voltage sags, the charge is followed over the legs.
#include "model/battery_charge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/watt_hours.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The Nomad on a lead battery of 4 Wh that is weak for its motors; nothing else limits them.
Robot on_curve() {
  Robot robot = testing::nomad();
  robot.battery = at_charge({.capacity_Wh = 4.0,
                             .internal_resistance_ohm = 0.9,
                             .reserve_fraction = 0.02,
                             .open_circuit_curve = {{0.0, 8.0}, {0.2, 11.0}, {0.9, 12.4}, {1.0, 13.0}}},
                            1.0);
  for (const Side side : kSides) {
    robot.motor[side].max_voltage_V = robot.motor[side].max_current_A = kNoLimit;
    robot.motor[side].friction_torque_Nm = 0.36;
  }
  return robot;
}

LegRequest line(double length_m) {
  const double third = length_m / 3;
  return {.path = PathRequest{.bezier_m = {{{{0, 0}, {third, 0}, {2 * third, 0}, {length_m, 0}}}}},
          .payload = {4, 4}};
}

MissionRequest lines(double fraction, int count = 3, double length_m = 9) {
  MissionRequest mission{.name = "lines"};
  for (int k = 0; k < count; ++k) mission.legs.push_back(line(length_m));
  mission.start.battery_fraction = fraction;
  return mission;
}

MissionRequest fastest(MissionRequest mission) {
  mission.objective.minimize = Objective::Minimize::time;
  return mission;
}

Plan drive(const MissionRequest& mission, const Robot& robot, std::size_t nodes = 60) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = nodes, .baselines = false});
}

bool drives(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

/// (R_m + 2 R_b) i + Kv n q' = U on a straight line at the voltage limit, both wheels alike, no standby.
TEST(BatteryVoltage, AStraightLineAtTheLimitHasAClosedForm) {
  Robot robot = on_curve();
  robot.power.standby_W = 0;
  robot.battery.capacity_Wh = 1e5;  // the charge stays
  robot.limits = Limits{};
  const double U = open_circuit_voltage_V(robot.battery, 0.6);
  const Plan plan = drive(fastest(lines(0.6, 1, 40)), robot, 300);
  ASSERT_TRUE(drives(plan)) << plan.message;
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 20);
  const Motor& motor = robot.motor.left;
  const double resistance_ohm = motor.resistance_ohm + 2 * robot.battery.internal_resistance_ohm;
  const double brakes_s = rows.time_s.back() - 4;
  int rows_at_limit = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double used_V = resistance_ohm * rows.motor_current_A.left[k] +
                          motor.volts_per_speed_V_s_rad() * rows.wheel_speed_rad_s.left[k];
    EXPECT_LT(used_V, U * (1 + 2e-6)) << rows.time_s[k];
    const bool accelerates = rows.time_s[k] > 1 && rows.time_s[k] < brakes_s;
    EXPECT_TRUE(!accelerates || used_V > U * (1 - 5e-3)) << rows.time_s[k];
    rows_at_limit += used_V > U * (1 - 5e-3);
  }
  EXPECT_GT(rows_at_limit, 1000);
  const double per_torque = resistance_ohm / motor.torque_per_ampere_Nm_A();
  const double steady_rad_s =
      (U - per_torque * motor.friction_torque_Nm) /
      (per_torque * motor.viscous_friction_Nm_s_rad + motor.volts_per_speed_V_s_rad());
  const double most_m_s = *std::max_element(rows.linear_speed_m_s.begin(), rows.linear_speed_m_s.end());
  EXPECT_NEAR(most_m_s, 0.1 * steady_rad_s, 1e-4 * most_m_s);
}

TEST(BatteryVoltage, NoMotorHasMoreThanTheBatteryGives) {
  const Robot robot = on_curve();
  MissionRequest mission = fastest(lines(0.7, 2, 6));
  mission.legs.push_back({.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}}});
  const Plan plan = drive(mission, robot);
  ASSERT_TRUE(drives(plan)) << plan.message;
  EXPECT_LE(plan.worst_violation, 1e-6);
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 100);
  double closest = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto leg = static_cast<std::size_t>(rows.leg[k]);
    const double U = plan.legs[leg].state.open_circuit_voltage_V, P = rows.battery_power_W[k], R = 0.9;
    const double terminal_V = 0.5 * U + std::sqrt(0.25 * U * U - R * P);
    for (const Side side : kSides) {
      const double use = std::abs(rows.motor_voltage_V[side][k]) / terminal_V;
      EXPECT_LT(use, 1 + 1e-5) << rows.time_s[k];
      closest = std::max(closest, use);
    }
  }
  EXPECT_GT(closest, 0.999);
}

/// The verdict offers what a robot or mission file states: never the voltage itself.
TEST(BatteryVoltage, APrescribedMotionBeyondItIsRefusedWithWhatWorks) {
  const PrescribedMotion motion{
      .profile = MotionProfile::trapezoid, .acceleration_m_s2 = 0.2, .speed_m_s = 0.55, .distance_m = 5};
  MissionRequest mission{.name = "prescribed", .legs = {{.motion = motion, .payload = {4, 4}}}};
  mission.start.battery_fraction = 0.25;
  Robot robot = on_curve();
  const Plan low = drive(mission, robot);
  ASSERT_TRUE(low.infeasibility) << low.message;
  EXPECT_EQ(low.infeasibility->reason.constraint, "battery_voltage");
  ASSERT_EQ(low.infeasibility->reason.relaxation.count("battery_fraction"), 1u) << low.message;
  EXPECT_EQ(low.infeasibility->reason.relaxation.size(), 1u) << low.message;
  EXPECT_NE(low.message.find("battery_fraction"), std::string::npos) << low.message;
  EXPECT_EQ(low.message.find("battery_voltage_V"), std::string::npos) << low.message;
  mission.start.battery_fraction = low.infeasibility->reason.relaxation.at("battery_fraction");
  EXPECT_TRUE(drives(drive(mission, robot)));

  robot.battery.internal_resistance_ohm = 1.8;
  mission.start.battery_fraction = 1.0;
  const Plan weak = drive(mission, robot);
  ASSERT_TRUE(weak.infeasibility) << weak.message;
  ASSERT_EQ(weak.infeasibility->reason.relaxation.count("internal_resistance_ohm"), 1u) << weak.message;
  robot.battery.internal_resistance_ohm = weak.infeasibility->reason.relaxation.at("internal_resistance_ohm");
  EXPECT_TRUE(drives(drive(mission, robot)));
}

TEST(BatteryCharge, AnEmptierBatteryDrivesSlower) {
  double before_s = 0;
  for (const double fraction : {1.0, 0.6, 0.3, 0.15}) {
    const Plan plan = drive(fastest(lines(fraction)), on_curve());
    ASSERT_TRUE(drives(plan)) << fraction << ": " << plan.message;
    EXPECT_GT(plan.duration_s, before_s * 1.01) << fraction;
    before_s = plan.duration_s;
  }
}

/// The charge after each leg from the rows of the plan alone, and the voltage that each leg was planned with.
TEST(BatteryCharge, IsFollowedFromLegToLeg) {
  const Robot robot = on_curve();
  const Plan plan = drive(fastest(lines(0.8)), robot);
  ASSERT_TRUE(drives(plan)) << plan.message;
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 500);
  double mean_V = 0, fraction = 0.8;
  for (int k = 0; k < 1000; ++k) mean_V += open_circuit_voltage_V(robot.battery, (k + 0.5) / 1000) / 1000;
  const double charge_As = robot.battery.capacity_Wh * kJoulesPerWh / mean_V;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const auto leg = static_cast<std::size_t>(rows.leg[k]);
    const double U = open_circuit_voltage_V(robot.battery, fraction),
                 step_s = rows.time_s[k + 1] - rows.time_s[k];
    const double P = 0.5 * (rows.battery_power_W[k] + rows.battery_power_W[k + 1]);
    fraction -= (0.5 * U - std::sqrt(0.25 * U * U - 0.9 * P)) / 0.9 * step_s / charge_As;
    if (static_cast<std::size_t>(rows.leg[k + 1]) == leg && k + 2 < rows.size()) continue;
    EXPECT_NEAR(plan.battery->fraction_after_leg[leg], fraction, 1e-3) << leg;
    EXPECT_NEAR(plan.legs[leg].state.open_circuit_voltage_V,
                open_circuit_voltage_V(robot.battery, plan.battery->fraction_after_leg[leg]), 1e-3);
  }
  ASSERT_TRUE(plan.battery->voltage_error_V);
  EXPECT_GT(*plan.battery->voltage_error_V, 0.02);
  EXPECT_LT(*plan.battery->voltage_error_V, 1.0);
}

/// What a verdict on the reserve offers is accepted by the reader: a fraction up to 1, else a capacity.
TEST(BatteryCharge, ATooSmallBatteryIsOfferedWhatWorks) {
  const PrescribedMotion motion{
      .profile = MotionProfile::trapezoid, .acceleration_m_s2 = 0.2, .speed_m_s = 0.3, .distance_m = 9};
  MissionRequest mission{.name = "prescribed", .legs = {{.motion = motion}, {.motion = motion}}};
  mission.start.battery_fraction = 0.05;
  const Robot robot = on_curve();
  const Plan low = drive(mission, robot);
  ASSERT_TRUE(low.infeasibility) << low.message;
  EXPECT_EQ(low.infeasibility->reason.constraint, "battery_reserve");
  ASSERT_TRUE(low.infeasibility->reason.relaxation.contains("battery_fraction")) << low.message;
  const double enough = low.infeasibility->reason.relaxation.at("battery_fraction");
  mission.start.battery_fraction = enough;
  EXPECT_TRUE(drives(drive(mission, robot)));
  mission.start.battery_fraction = enough - 0.01;
  EXPECT_FALSE(drives(drive(mission, robot)));

  mission.start.battery_fraction = 1.0;
  Robot small = robot;
  small.battery.capacity_Wh = 0.1;
  const Plan empty = drive(mission, small);
  ASSERT_TRUE(empty.infeasibility) << empty.message;
  ASSERT_TRUE(empty.infeasibility->reason.relaxation.contains("capacity_Wh")) << empty.message;
  EXPECT_FALSE(empty.infeasibility->reason.relaxation.contains("battery_fraction"));
  small.battery.capacity_Wh = empty.infeasibility->reason.relaxation.at("capacity_Wh");
  EXPECT_GT(small.battery.capacity_Wh, 0.1);
  EXPECT_TRUE(drives(drive(mission, small)));
  small.battery.capacity_Wh *= 0.95;
  EXPECT_FALSE(drives(drive(mission, small)));
}

/// Behind a charger the motors have what it filled, though the mission begins nearly empty.
TEST(BatteryCharge, ALegBehindAChargerHasWhatItFilled) {
  const Robot robot = on_curve();
  const PrescribedMotion quick{
      .profile = MotionProfile::trapezoid, .acceleration_m_s2 = 0.2, .speed_m_s = 0.55, .distance_m = 5};
  MissionRequest mission = lines(0.12, 1, 3);
  mission.legs[0].to = "charger";
  mission.legs[0].dwell_s = 3600;
  mission.legs.push_back({.motion = quick, .payload = {4, 4}});
  EXPECT_FALSE(drives(drive(mission, robot)));
  mission.stations["charger"] = {.x_m = 3, .charger_W = 60};
  mission.charging = ChargingRequest{.to_fraction = 0.95};
  const Plan plan = drive(mission, robot);
  ASSERT_TRUE(drives(plan)) << plan.message;
  EXPECT_NEAR(plan.battery->fraction_after_leg[0], 0.95, 1e-9);
  EXPECT_LT(plan.legs[1].state.open_circuit_voltage_V, open_circuit_voltage_V(robot.battery, 0.95));
  EXPECT_GT(plan.legs[1].state.open_circuit_voltage_V, open_circuit_voltage_V(robot.battery, 0.8));
}

/// A constant voltage limits no motor: as before.
TEST(BatteryCharge, WithoutACurveTheMotorsSeeNoBattery) {
  Robot robot = on_curve();
  robot.battery.open_circuit_curve.clear();
  const Plan plan = drive(fastest(lines(0.7)), robot);
  ASSERT_TRUE(drives(plan)) << plan.message;
  EXPECT_FALSE(plan.battery->voltage_error_V);
  EXPECT_LT(plan.duration_s, drive(fastest(lines(0.7)), on_curve()).duration_s);
}

TEST(ChargeCurrent, BrakingReturnsNoMoreThanTheBatteryTakes) {
  Robot robot = testing::nomad();
  robot.power = {.standby_W = 2, .regeneration_efficiency = 0.9};
  robot.limits->acceleration_m_s2 = robot.limits->deceleration_m_s2 = 2;
  for (const Side side : kSides) robot.motor[side].friction_torque_Nm = 0.05;
  const Plan free = drive(fastest(lines(0.9, 1)), robot);
  robot.battery.max_charge_current_A = 0.5;
  const Plan kept = drive(fastest(lines(0.9, 1)), robot);
  ASSERT_TRUE(drives(free) && drives(kept)) << kept.message;
  const auto least_W = [&](const Plan& plan) {
    const Trajectory rows = plan_trajectory(plan, make_plant(robot), 200);
    return *std::min_element(rows.battery_power_W.begin(), rows.battery_power_W.end());
  };
  const double most_W = (25 + 0.05 * 0.5) * 0.5;
  EXPECT_LT(least_W(free), -1.5 * most_W);
  EXPECT_GT(least_W(kept), -most_W * (1 + 1e-5));
  EXPECT_LT(least_W(kept), -0.99 * most_W);
  EXPECT_GT(kept.duration_s, free.duration_s);
}

}  // namespace
}  // namespace joulepath
