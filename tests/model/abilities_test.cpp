#include "model/abilities.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// On a straight line at a steady speed i = (T_m + nu w)/(Kt n) and V = R i + Kv n w [P1, Eqs. (19)-(28)].
TEST(Abilities, AreTheSteadyStatesInClosedForm) {
  Robot robot = testing::nomad();
  robot.limits->speed_m_s = 0.8;
  robot.battery.capacity_Wh = 100;
  robot.battery.reserve_fraction = 0.2;
  const Abilities able = abilities_of(robot);
  double slowest_m_s = kNoLimit, motors_W = 0;
  for (const Side side : kSides) {
    const Motor& m = robot.motor[side];
    const double r = robot.geometry.wheel_radius_m[side], K = m.torque_per_ampere_Nm_A(),
                 Kv = m.volts_per_speed_V_s_rad();
    const double w = (m.max_voltage_V - m.resistance_ohm * m.friction_torque_Nm / K) /
                     (Kv + m.resistance_ohm * m.viscous_friction_Nm_s_rad / K);
    slowest_m_s = std::min(slowest_m_s, r * w);
    const double at = 0.8 / r, i = (m.friction_torque_Nm + m.viscous_friction_Nm_s_rad * at) / K;
    motors_W += i * (m.resistance_ohm * i + Kv * at);
  }
  EXPECT_NEAR(able.top_speed_m_s, slowest_m_s, 1e-9);
  EXPECT_EQ(able.cruise_m_s, 0.8);
  EXPECT_NEAR(able.energy_J_m, (motors_W + robot.power.standby_W) / 0.8, 1e-9);
  EXPECT_NEAR(able.distance_m, 0.8 * 3600 * 100 / able.energy_J_m, 1e-6);
}

/// On a grade of rise over run g the weight's part along the slope is m g sin(atan(g)); no grade asks for
/// more than the weight.
TEST(Abilities, TheGradeIsRiseOverRun) {
  Robot robot = testing::nomad();
  for (const double grade : {0.05, 0.6, 3.0}) {
    const double wheel_N = 0.5 * robot.total_mass_kg(0) * kGravity_m_s2 * std::sin(std::atan(grade));
    for (const Side side : kSides) {
      Motor& motor = robot.motor[side];
      const double torque_Nm = wheel_N * robot.geometry.wheel_radius_m[side] + motor.friction_torque_Nm;
      motor.max_current_A = torque_Nm / motor.torque_per_ampere_Nm_A();
    }
    EXPECT_NEAR(abilities_of(robot).grade, grade, 1e-4 * grade);
  }
  for (const Side side : kSides) robot.motor[side].max_current_A *= 1.1;
  EXPECT_EQ(abilities_of(robot).grade, kNoLimit);
}

/// More friction, less voltage: never faster. Friction above the motor's torque: no motion.
TEST(Abilities, FallWithFrictionAndVoltage) {
  Robot robot = testing::nomad();
  double before_m_s = kNoLimit;
  for (const double torque_Nm : {0.1, 1.0, 5.0, 12.0, 14.0}) {
    for (const Side side : kSides) robot.motor[side].friction_torque_Nm = torque_Nm;
    const Abilities able = abilities_of(robot);
    EXPECT_LT(able.top_speed_m_s, before_m_s);
    before_m_s = able.top_speed_m_s;
    EXPECT_EQ(able.can_move(), torque_Nm < able.motor_torque_Nm.left);
  }
  EXPECT_EQ(before_m_s, 0.0);
}

}  // namespace
}  // namespace joulepath
