// Every effect's law by closed form on a simple motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model/effects/catalog.hpp"
#include "model/effects/yardsticks.hpp"
#include "model/power.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

constexpr double kPayload_kg = 8.0;
constexpr double kRadius_m = 0.1;
constexpr double kHalfTrack_m = 0.165;
constexpr double kMass_kg = 21.2 + 2 * 1.39 + kPayload_kg;
constexpr double kNormal_N = kMass_kg * kGravity_m_s2 / 2;
const BodyMotion<double> kCruise{.speed_m_s = 0.5};
const BodyMotion<double> kReverse{.speed_m_s = -0.5};
const BodyMotion<double> kSpinning{.yaw_rate_rad_s = 1.0};

struct Wheels {
  Sided<double> torque_Nm{}, current_A{}, voltage_V{}, speed_rad_s{};
};

struct Circumstances {
  Pose pose{};
  double time_of_day_s{};
  EffectMemory memory{};
};

Wheels wheels_with(const std::vector<EffectSetting>& effects, const BodyMotion<double>& motion,
                   const Circumstances& at = {}) {
  const Plant plant = make_plant(nomad(), effects);
  Site site = site_of(plant.robot.geometry, at.pose, kPayload_kg, motion.speed_m_s, motion.yaw_rate_rad_s,
                      at.time_of_day_s);
  site.memory = at.memory;
  const auto wheels = operating_point(plant, motion, site);
  Wheels out;
  for (Side side : kSides) {
    out.torque_Nm[side] = wheels[side].torque_Nm;
    out.current_A[side] = wheels[side].current_A;
    out.voltage_V[side] = wheels[side].voltage_V;
    out.speed_rad_s[side] = wheels[side].speed_rad_s;
  }
  return out;
}

/// Torque that an effect adds to each wheel.
Sided<double> extra_torque_Nm(const EffectSetting& effect, const BodyMotion<double>& motion,
                              const Circumstances& at = {}) {
  const Wheels with = wheels_with({effect}, motion, at);
  const Wheels without = wheels_with({}, motion, at);
  return {with.torque_Nm.left - without.torque_Nm.left, with.torque_Nm.right - without.torque_Nm.right};
}

void expect_extra_Nm(const EffectSetting& effect, const BodyMotion<double>& motion, double left, double right,
                     const Circumstances& at = {}) {
  const Sided<double> extra = extra_torque_Nm(effect, motion, at);
  EXPECT_NEAR(extra.left, left, 1e-12) << effect.name;
  EXPECT_NEAR(extra.right, right, 1e-12) << effect.name;
}

TEST(EffectLaw, RollingResistanceIsCoefficientTimesLoadTimesRadius) {
  const double torque = 0.02 * kNormal_N * kRadius_m;
  expect_extra_Nm({.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}, kCruise, torque,
                  torque);
  expect_extra_Nm({.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}, kReverse, -torque,
                  -torque);
}

TEST(EffectLaw, FloorPatchActsInsideOfItsRegionOnly) {
  EffectSetting patch{
      .name = "floor_patch",
      .parameters = {{"coefficient", 0.02}, {"x_min_m", 0}, {"x_max_m", 1}, {"y_min_m", 0}, {"y_max_m", 1}}};
  const double torque = 0.02 * kNormal_N * kRadius_m;
  expect_extra_Nm(patch, kCruise, torque, torque, {.pose = {0.5, 0.5, 0}});
  expect_extra_Nm(patch, kCruise, 0, 0, {.pose = {1.5, 0.5, 0}});
  patch.parameters = {{"coefficient", 0.02}};
  patch.cells = {{1.0, 2.0, 0.0, 1.0}, {5.0, 6.0, 5.0, 6.0}};
  expect_extra_Nm(patch, kCruise, torque, torque, {.pose = {1.5, 0.5, 0}});
  expect_extra_Nm(patch, kCruise, 0, 0, {.pose = {0.5, 0.5, 0}});
}

TEST(EffectLaw, StribeckFrictionFadesAsAGaussian) {
  const double torque = 0.1 * std::exp(-std::pow(5.0 / 4.0, 2));
  expect_extra_Nm({.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.1}, {"speed_rad_s", 4.0}}},
                  kCruise, torque, torque);
}

TEST(EffectLaw, ConstantFrictionsActOnTheirWheels) {
  expect_extra_Nm({.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.04}}}, kCruise, 0.04, 0.04);
  expect_extra_Nm({.name = "dragging_wheel", .parameters = {{"torque_Nm", 0.07}}, .side = Side::right},
                  kCruise, 0.0, 0.07);
  const EffectSetting backward{.name = "direction_dependent_friction",
                               .parameters = {{"reverse_torque_Nm", 0.05}}};
  expect_extra_Nm(backward, kCruise, 0, 0);
  expect_extra_Nm(backward, kReverse, -0.05, -0.05);
  expect_extra_Nm(backward, kSpinning, -0.05, 0);  // turning left, the left wheel runs backward
}

TEST(EffectLaw, ViscousFrictionGrowsWithWheelSpeed) {
  expect_extra_Nm({.name = "viscous_friction", .parameters = {{"coefficient_Nm_s_rad", 0.01}}}, kCruise,
                  0.01 * 5, 0.01 * 5);
}

TEST(EffectLaw, GearLosesAFractionOfWhatTheMotorTransmits) {
  const EffectSetting gear{.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.2}}};
  for (double acceleration : {0.3, -1.5}) {  // driving, and braked by the motor
    const BodyMotion<double> motion{.speed_m_s = 0.5, .acceleration_m_s2 = acceleration};
    const Wheels with = wheels_with({gear}, motion);
    const Wheels without = wheels_with({}, motion);
    EXPECT_NEAR(with.torque_Nm.left - 0.2 * std::abs(with.torque_Nm.left), without.torque_Nm.left, 1e-12);
  }
}

TEST(EffectLaw, TurningScrubIsAMomentAgainstTheTurn) {
  const double torque = 0.4 * kRadius_m / (2 * kHalfTrack_m);
  const EffectSetting scrub{.name = "turning_scrub", .parameters = {{"moment_Nm", 0.4}}};
  expect_extra_Nm(scrub, kSpinning, -torque, torque);
  expect_extra_Nm(scrub, {.yaw_rate_rad_s = -1.0}, torque, -torque);
  expect_extra_Nm(scrub, kCruise, 0, 0);
}

TEST(EffectLaw, CasterSwivelDecaysWithTheWayAfterAChangeOfCourse) {
  const EffectSetting caster{.name = "caster_swivel", .parameters = {{"moment_Nm", 0.6}, {"trail_m", 0.1}}};
  const Plant plant = make_plant(nomad(), {caster});
  EffectMemory memory{};  // it came straight on
  for (double way_m : {0.0, 0.05, 0.2}) {
    memory = {};
    advance_memory(plant, way_m, 1.0, memory);
    const double torque = 0.6 * std::exp(-way_m / 0.1) * kRadius_m / (2 * kHalfTrack_m);
    expect_extra_Nm(caster, kSpinning, -torque, torque, {.memory = memory});
  }
  expect_extra_Nm(caster, kCruise, 0, 0);
}

TEST(EffectLaw, QuadraticDragIsHalvedBetweenTheWheels) {
  const EffectSetting drag{.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 4.0}}};
  const double torque = 4.0 * 0.25 / 2 * kRadius_m;
  expect_extra_Nm(drag, kCruise, torque, torque);
  expect_extra_Nm(drag, kReverse, -torque, -torque);
}

TEST(EffectLaw, WheelSlipTurnsTheWheelFasterByForceOverStiffness) {
  const BodyMotion<double> motion{.speed_m_s = 0.5, .acceleration_m_s2 = 0.4};
  const Wheels with =
      wheels_with({{.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 2000}}}}, motion);
  EXPECT_NEAR(with.speed_rad_s.left, (0.5 + kMass_kg * 0.4 / 2 / 2000) / kRadius_m, 1e-12);
}

TEST(EffectLaw, PayloadMassErrorScalesTheStatedPayload) {
  const BodyMotion<double> motion{.speed_m_s = 0.5, .acceleration_m_s2 = 0.4};
  const double torque = 0.25 * kPayload_kg * 0.4 / 2 * kRadius_m;
  expect_extra_Nm({.name = "payload_mass_error", .parameters = {{"fraction", 0.25}}}, motion, torque, torque);
}

TEST(EffectLaw, CenterOfMassOffsetCouplesSpeedAndTurn) {
  const BodyMotion<double> motion{.speed_m_s = 0.5, .yaw_rate_rad_s = 0.8};
  const double mu = (21.2 + kPayload_kg) * 0.05;
  const double from_force = -mu * 0.64 / 2 * kRadius_m;
  const double from_moment = mu * 0.5 * 0.8 / (2 * kHalfTrack_m) * kRadius_m;
  expect_extra_Nm({.name = "center_of_mass_offset", .parameters = {{"offset_m", 0.05}}}, motion,
                  from_force - from_moment, from_force + from_moment);
}

TEST(EffectLaw, YawInertiaErrorResistsYawAcceleration) {
  const BodyMotion<double> motion{.speed_m_s = 0.5, .yaw_rate_rad_s = 0.8, .yaw_acceleration_rad_s2 = 1.5};
  const double torque = 0.2 * 0.5 * 1.5 / (2 * kHalfTrack_m) * kRadius_m;
  expect_extra_Nm({.name = "yaw_inertia_error", .parameters = {{"fraction", 0.2}}}, motion, -torque, torque);
}

TEST(EffectLaw, GeometryErrorsChangeTheWheelSpeeds) {
  const BodyMotion<double> motion{.speed_m_s = 0.5, .yaw_rate_rad_s = 0.8};
  const Wheels larger =
      wheels_with({{.name = "wheel_radius_error", .parameters = {{"fraction", 0.02}}}}, motion);
  EXPECT_NEAR(larger.speed_rad_s.left, (0.5 - kHalfTrack_m * 0.8) / 0.102, 1e-12);
  const Wheels apart =
      wheels_with({{.name = "wheel_radius_mismatch", .parameters = {{"fraction", 0.02}}}}, motion);
  EXPECT_NEAR(apart.speed_rad_s.left, (0.5 - kHalfTrack_m * 0.8) / 0.101, 1e-12);
  EXPECT_NEAR(apart.speed_rad_s.right, (0.5 + kHalfTrack_m * 0.8) / 0.099, 1e-12);
  const Wheels wider =
      wheels_with({{.name = "track_width_error", .parameters = {{"fraction", 0.1}}}}, motion);
  EXPECT_NEAR(wider.speed_rad_s.right, (0.5 + 1.1 * kHalfTrack_m * 0.8) / kRadius_m, 1e-12);
}

TEST(EffectLaw, FloorSlopeWeighsAgainstTheWayUp) {
  const EffectSetting slope{.name = "floor_slope",
                            .parameters = {{"grade", 0.03}, {"uphill_direction_rad", 0.5}}};
  for (double heading : {0.5, 2.0, 0.5 + std::numbers::pi}) {
    const double torque = kMass_kg * kGravity_m_s2 * 0.03 * std::cos(heading - 0.5) / 2 * kRadius_m;
    expect_extra_Nm(slope, kCruise, torque, torque, {.pose = {0, 0, heading}});
  }
}

TEST(EffectLaw, ElectricalEffectsChangeTheVoltageOrTheCurrent) {
  const Wheels plain = wheels_with({}, kCruise);
  const double i = plain.current_A.left;
  const Wheels warm =
      wheels_with({{.name = "winding_resistance_error", .parameters = {{"fraction", 0.1}}}}, kCruise);
  EXPECT_NEAR(warm.voltage_V.left - plain.voltage_V.left, 0.1 * 2.74 * i, 1e-12);
  const Wheels heating = wheels_with(
      {{.name = "winding_heating", .parameters = {{"final_fraction", 0.2}, {"time_constant_s", 100}}}},
      kCruise, {.time_of_day_s = 150});
  EXPECT_NEAR(heating.voltage_V.left - plain.voltage_V.left, 0.2 * (1 - std::exp(-1.5)) * 2.74 * i, 1e-12);
  const Wheels weak =
      wheels_with({{.name = "torque_constant_error", .parameters = {{"fraction", -0.1}}}}, kCruise);
  EXPECT_NEAR(weak.current_A.left, i / 0.9, 1e-12);
  EXPECT_NEAR(weak.voltage_V.left, 2.74 * i / 0.9 + 0.9 * 0.069 * 24.9 * 5, 1e-12);
  const Wheels drop =
      wheels_with({{.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.3}}}}, kReverse);
  EXPECT_NEAR(drop.voltage_V.left, -plain.voltage_V.left - 0.3, 1e-12);
}

TEST(EffectLaw, SupplyEffectsChangeWhatTheBatteryGives) {
  const Plant standby =
      make_plant(nomad(), {{.name = "standby_power_error", .parameters = {{"power_W", 3}}}});
  EXPECT_EQ(standby.robot.power.standby_W, 13);
  const Plant regenerating =
      make_plant(nomad(), {{.name = "regeneration_error", .parameters = {{"efficiency", 0.4}}}});
  EXPECT_NEAR(supply_power_W(regenerating.robot.power, {-10.0, 5.0}), 5 - 4, 1e-12);
  const Plant sagging =
      make_plant(nomad(), {{.name = "supply_sag", .parameters = {{"resistance_ohm", 0.5}}}});
  const BatteryLoad load = battery_load(sagging.robot.battery, 100.0);
  EXPECT_NEAR(load.terminal_voltage_V, 25 - 0.5 * load.current_A, 1e-12);
  EXPECT_NEAR(load.terminal_voltage_V * load.current_A, 100.0, 1e-9);
}

TEST(EffectLaw, InstrumentsChangeReadings) {
  Trajectory log{.time_s = {0, 1, 2, 3}, .motor_voltage_V = {{0, 2, 4, 6}, {0, 2, 4, 6}}};
  log.motor_current_A = {{0, 1, 2, 3}, {0, 1, 2, 3}};
  const auto distorted = [&](const EffectSetting& setting) {
    Trajectory copy = log;
    distort_log({make_effect(setting)}, copy);
    return copy;
  };
  const Trajectory offset =
      distorted({.name = "current_sensor_offset", .parameters = {{"offset_A", 0.5}}, .side = Side::right});
  EXPECT_EQ(offset.motor_current_A.left[2], 2);
  EXPECT_EQ(offset.motor_current_A.right[2], 2.5);
  const Trajectory gain = distorted({.name = "current_sensor_gain", .parameters = {{"fraction", 0.1}}});
  EXPECT_NEAR(gain.motor_current_A.left[3], 3.3, 1e-12);
  const Trajectory late = distorted({.name = "time_misalignment", .parameters = {{"delay_s", 0.5}}});
  EXPECT_NEAR(late.motor_voltage_V.left[2], 3.0, 1e-12);
  EXPECT_NEAR(late.motor_current_A.right[2], 1.5, 1e-12);
  EXPECT_EQ(late.wheel_speed_rad_s.left.size(), 0u);
}

TEST(Plant, EffectsOfOneKindAddUp) {
  const EffectSetting slip{.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 400}}};
  const EffectSetting drop{.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.3}}};
  const EffectSetting gear{.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.1}}};
  const Plant plant = make_plant(nomad(), {slip, drop, gear, slip, drop, gear});
  EXPECT_NEAR(plant.creep_m_s_N, 2.0 / 400, 1e-15);
  EXPECT_NEAR(plant.driver_voltage_drop_V, 0.6, 1e-15);
  EXPECT_NEAR(plant.torque_loss_fraction, 2 * make_plant(nomad(), {gear}).torque_loss_fraction, 1e-15);
}

TEST(EffectCatalog, WithoutAGridOfItsOwnASearchSpansADecadeAroundTheTypicalSize) {
  int searched = 0;
  for (const EffectDescription& effect : effect_catalog())
    for (const ParameterDescription& parameter : effect.parameters) {
      if (!parameter.grid.empty()) continue;
      const std::vector<double> grid = search_grid(parameter, nomad());
      const double typical = typical_size(parameter, nomad());
      ASSERT_EQ(grid.size(), 3u);
      for (std::size_t k = 0; k < 3; ++k) {
        const double factor = std::array{0.3, 1.0, 3.0}[k];
        EXPECT_EQ(grid[k], std::clamp(factor * typical, parameter.min, parameter.max));
      }
      ++searched;
    }
  EXPECT_GT(searched, 5);
}

/// Sizes are typical of what resists the robot: friction of its motors, and rolling at a hundredth of its
/// chassis' weight.
TEST(Yardsticks, OfARobotWithoutMotorFrictionAreThoseOfItsRolling) {
  Robot robot = testing::nomad();
  for (Side side : kSides) robot.motor[side].friction_torque_Nm = 0;
  const double rolling_N = 0.01 * 9.81 * robot.inertia.chassis_mass_kg;
  EXPECT_NEAR(robot_measures::resisting_force_N(robot), rolling_N, 1e-9);
  EXPECT_NEAR(robot_measures::resisting_moment_Nm(robot), rolling_N * robot.geometry.half_track_m, 1e-9);
  EXPECT_NEAR(robot_measures::resisting_torque_Nm(robot), rolling_N / 2 * 0.1, 1e-9);
}

}  // namespace
}  // namespace joulepath
