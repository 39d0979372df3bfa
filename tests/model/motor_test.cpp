#include "model/motor.hpp"

#include <gtest/gtest.h>

#include "model/operating_point.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

TEST(MotorPower, AtStandstillIsCopperLossOnly) {
  const Motor motor = nomad().motor.left;
  const double current_A = motor_current_A(motor, 0.5);
  EXPECT_NEAR(motor_power_W(motor, 0.5, 0.0), 2.74 * current_A * current_A, 1e-12);
}

TEST(MotorPower, IsCopperLossPlusMechanicalPowerWhereTheConstantsAgree) {
  const Motor motor = nomad().motor.left;
  for (double torque_Nm : {-0.7, 0.2, 1.4})
    for (double speed_rad_s : {-6.0, 3.0}) {
      const double current_A = torque_Nm / (0.069 * 24.9);
      EXPECT_NEAR(motor_power_W(motor, torque_Nm, speed_rad_s),
                  2.74 * current_A * current_A + torque_Nm * speed_rad_s, 1e-12);
      EXPECT_NEAR(motor_voltage_V(motor, current_A, speed_rad_s),
                  2.74 * current_A + 0.069 * 24.9 * speed_rad_s, 1e-12);
    }
}

TEST(MotorPower, IsWhatTheOperatingPointSays) {
  const Plant plant = make_plant(nomad());
  const BodyMotion<double> motion{0.5, 0.3, 0.8, -0.4};
  const auto wheels = operating_point(plant, motion, site_of(plant.robot.geometry, {}, 2.0, 0.5, 0.8));
  for (Side side : kSides)
    EXPECT_NEAR(wheels[side].power_W,
                motor_power_W(plant.robot.motor[side], wheels[side].torque_Nm, wheels[side].speed_rad_s),
                1e-12);
}

}  // namespace
}  // namespace joulepath
