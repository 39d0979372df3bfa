#include "model/operating_point.hpp"

#include <gtest/gtest.h>

#include <random>

#include "model/power.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

using testing::nomad;
using testing::typical_effect;

Site moving_site(const Robot& robot, const BodyMotion<double>& motion, double payload_kg = 0.0) {
  return site_of(robot.geometry, {.x_m = 0.3, .y_m = -0.2, .heading_rad = 0.7}, payload_kg, motion.speed_m_s,
                 motion.yaw_rate_rad_s);
}

TEST(OperatingPoint, AtStandstillWithoutAccelerationNothingFlows) {
  const Plant plant = make_plant(nomad());
  const auto wheels = operating_point<double>(plant, {}, Site{});
  EXPECT_EQ(wheels.left.current_A, 0.0);
  EXPECT_EQ(wheels.right.power_W, 0.0);
}

TEST(OperatingPoint, StraightLineGivesThePrintedCoefficients) {
  // [P1, Eq. (31)]: 0.0203 q''^2 + 0.148 q'' q' + 0.102 q'' + 0.0017 q'^2 + 0.373 q' + 0.129 without payload.
  const Robot robot = nomad();
  const Plant plant = make_plant(robot);
  const auto power_W = [&](double q1, double q2) {
    const BodyMotion<double> motion{.speed_m_s = 0.1 * q1, .acceleration_m_s2 = 0.1 * q2};
    return operating_point(plant, motion, moving_site(robot, motion)).left.power_W;
  };
  const double base = power_W(1e-9, 0);
  EXPECT_NEAR(base, 0.129, 0.0005);
  EXPECT_NEAR((power_W(1e-9, 1) + power_W(1e-9, -1)) / 2 - base, 0.0203, 0.00005);
  EXPECT_NEAR((power_W(1e-9, 1) - power_W(1e-9, -1)) / 2, 0.102, 0.0005);
  EXPECT_NEAR((power_W(2, 1) - power_W(2, -1) - power_W(1e-9, 1) + power_W(1e-9, -1)) / 4, 0.148, 0.0005);
}

TEST(OperatingPoint, MirroredRobotOnMirroredPathSwapsTheWheels) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 100; ++i) {
    Robot robot = nomad();
    robot.geometry.center_of_mass_offset_m = 0.1 * uniform(random);
    robot.geometry.wheel_radius_m = {0.1, 0.11};
    Robot mirrored = robot;
    std::swap(mirrored.motor.left, mirrored.motor.right);
    std::swap(mirrored.geometry.wheel_radius_m.left, mirrored.geometry.wheel_radius_m.right);
    const BodyMotion<double> motion{uniform(random), uniform(random), uniform(random), uniform(random)};
    const BodyMotion<double> reflected{motion.speed_m_s, motion.acceleration_m_s2, -motion.yaw_rate_rad_s,
                                       -motion.yaw_acceleration_rad_s2};
    const auto a = operating_point(make_plant(robot), motion, moving_site(robot, motion, 5.0));
    const auto b = operating_point(make_plant(mirrored), reflected, moving_site(mirrored, reflected, 5.0));
    EXPECT_NEAR(a.left.power_W, b.right.power_W, 1e-12);
    EXPECT_NEAR(a.right.power_W, b.left.power_W, 1e-12);
  }
}

TEST(PowerByCause, AddsUpToTheMotorsPowerForEveryEffectInTheCatalog) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const EffectDescription& description : effect_catalog()) {
    Robot robot = nomad();
    robot.geometry.center_of_mass_offset_m = 0.05;
    const Plant plant = make_plant(robot, {typical_effect(description)});
    for (int i = 0; i < 20; ++i) {
      const BodyMotion<double> motion{uniform(random), uniform(random), uniform(random), uniform(random)};
      Site site = moving_site(plant.robot, motion, 5.7);
      site.time_of_day_s = 100;
      site.memory = {0.3, 0.3};
      const auto wheels = operating_point(plant, motion, site);
      const PowerByCause watts = power_by_cause(plant, motion, site);
      const double motors_W = wheels.left.power_W + wheels.right.power_W;
      EXPECT_NEAR(watts.motor_W(), motors_W, 1e-9 * (1 + std::abs(motors_W))) << description.info.name;
      EXPECT_NEAR(watts.total_W(),
                  supply_power_W(plant.robot.power, {wheels.left.power_W, wheels.right.power_W}) +
                      plant.robot.power.standby_W,
                  1e-9);
    }
  }
}

TEST(PowerByCause, KineticPowerIsTheRateOfKineticEnergy) {
  Robot robot = nomad();
  robot.geometry.center_of_mass_offset_m = 0.08;
  robot.payload_offset_m = -0.05;
  const Plant plant = make_plant(robot);
  const MassProperties mass = mass_properties(robot, 8.0);
  const BodyMotion<double> motion{0.7, 0.3, -0.9, 0.8};
  const auto energy_J = [&](double t) {
    const double v = motion.speed_m_s + t * motion.acceleration_m_s2;
    const double omega = motion.yaw_rate_rad_s + t * motion.yaw_acceleration_rad_s2;
    return kinetic_energy_J(robot, mass, v, omega, wheel_speeds_rad_s(robot.geometry, v, omega));
  };
  const double rate_W = (energy_J(1e-4) - energy_J(-1e-4)) / 2e-4;
  EXPECT_NEAR(power_by_cause(plant, motion, moving_site(robot, motion, 8.0)).kinetic_W, rate_W, 1e-7);
}

TEST(EffectCatalog, EveryEffectComesBackFromItsSetting) {
  for (const EffectDescription& description : effect_catalog()) {
    const EffectSetting setting = typical_effect(description);
    const EffectSetting back = setting_of(make_effect(setting));
    EXPECT_EQ(back.parameters, setting.parameters) << setting.name;
    EXPECT_EQ(back.side, setting.side) << setting.name;
  }
}

}  // namespace
}  // namespace joulepath
