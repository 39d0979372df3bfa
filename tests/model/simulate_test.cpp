#include "model/simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/config_error.hpp"
#include "model/simulation/controller.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

using testing::nomad;
using testing::typical_effect;

SimulationRequest request_for(const Robot& robot, const std::vector<PrescribedMotion>& motions,
                              double payload_kg = 0.0) {
  const TimedMotion motion = timed_motion(robot, motions, {.payload_kg = payload_kg});
  return {
      .robot = robot, .reference = motion.trajectory, .coasting = motion.coasting, .payload_kg = payload_kg};
}

const PrescribedMotion kStraight{.profile = MotionProfile::trapezoid, .speed_m_s = 0.6, .distance_m = 4};
const PrescribedMotion kBack{
    .profile = MotionProfile::trapezoid, .speed_m_s = 0.4, .distance_m = 1, .reverse = true};
const PrescribedMotion kArc{
    .profile = MotionProfile::arc, .speed_m_s = 0.5, .radius_m = 1.0, .angle_rad = 2.0};
const PrescribedMotion kSpin{.profile = MotionProfile::spin, .angle_rad = -2.5};
const PrescribedMotion kStand{.profile = MotionProfile::stand, .duration_s = 1.0};
const std::vector<PrescribedMotion> kTour{kStraight, kStand, kArc, kSpin, kStand, kBack, kSpin};

Robot crooked_robot() {
  Robot robot = nomad();
  robot.geometry.center_of_mass_offset_m = 0.06;
  robot.geometry.wheel_radius_m = {0.1, 0.101};
  return robot;
}

double imbalance_J(const EnergyBalance& b) {
  return b.motors_J - b.copper_J - b.driver_J - b.gear_J - b.wheel_friction_J - b.body_work_J - b.creep_J -
         b.stored_J;
}

TEST(Simulate, FollowsItsReferenceAndComesToRest) {
  const SimulationResult result = simulate(request_for(nomad(), kTour));
  EXPECT_TRUE(result.came_to_rest);
  EXPECT_LT(result.worst_speed_error_rad_s, 0.05);
  EXPECT_NEAR(result.final_pose.x_m, result.planned_pose.x_m, 0.01);
  EXPECT_NEAR(result.final_pose.y_m, result.planned_pose.y_m, 0.01);
  EXPECT_NEAR(result.final_pose.heading_rad, result.planned_pose.heading_rad, 0.005);
  EXPECT_EQ(result.saturated_fraction, 0.0);
}

TEST(Simulate, FeedbackHoldsTheSpeedAgainstUnmodeledEffects) {
  SimulationRequest request = request_for(nomad(), {kStraight});
  request.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.05}}}};
  const double with_feedback = simulate(request).worst_speed_error_rad_s;
  request.controller.proportional_V_s_rad = 0.0;
  const double integral_alone = simulate(request).worst_speed_error_rad_s;
  request.controller.integral_V_rad = 0.0;
  const double feed_forward_alone = simulate(request).worst_speed_error_rad_s;
  EXPECT_LT(with_feedback, 0.5 * integral_alone);
  EXPECT_LT(with_feedback, 0.4 * feed_forward_alone);
}

TEST(Simulate, EnergyInIsAccountedForUnderEveryEffect) {
  for (const EffectDescription& description : effect_catalog()) {
    SimulationRequest request = request_for(crooked_robot(), kTour, 5.0);
    request.effects = {typical_effect(description)};
    const SimulationResult result = simulate(request);
    EXPECT_NEAR(imbalance_J(result.balance), 0.0, 1e-5 * result.balance.motors_J) << description.info.name;
    EXPECT_TRUE(result.came_to_rest) << description.info.name;
  }
}

/// Compares a run at the usual tolerance with one at a thousandth of it and a tenth of the step.
void expect_independent_of_step(SimulationRequest request) {
  const SimulationResult coarse = simulate(request);
  request.integrator = {.tolerance = 1e-11, .max_step_s = 0.001};
  const SimulationResult fine = simulate(request);
  EXPECT_GT(fine.steps, 2 * coarse.steps);
  EXPECT_NEAR(coarse.energy_J / fine.energy_J, 1.0, 1e-6);
  EXPECT_NEAR(coarse.motor_energy_J.left / fine.motor_energy_J.left, 1.0, 1e-6);
  EXPECT_NEAR(coarse.final_pose.x_m, fine.final_pose.x_m, 1e-6);
  EXPECT_NEAR(coarse.final_pose.heading_rad, fine.final_pose.heading_rad, 1e-6);
}

TEST(Simulate, EnergyDoesNotDependOnTheStepSize) {
  SimulationRequest request = request_for(crooked_robot(), kTour, 5.0);
  expect_independent_of_step(request);
  request.effects = {
      {.name = "turning_scrub", .parameters = {{"moment_Nm", 0.4}}},
      {.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.05}, {"speed_rad_s", 1.0}}},
      {.name = "floor_patch",
       .parameters =
           {{"coefficient", 0.02}, {"x_min_m", 1}, {"x_max_m", 2}, {"y_min_m", -9}, {"y_max_m", 9}}},
      {.name = "regeneration_error", .parameters = {{"efficiency", 0.6}}}};
  expect_independent_of_step(request);
  request.effects.push_back({.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 2000}}});
  expect_independent_of_step(request);
}

TEST(Simulate, EnergyDoesNotDependOnTheStepSizeWithInductance) {
  SimulationRequest request = request_for(crooked_robot(), kTour, 5.0);
  for (Side side : kSides) request.robot.motor[side].inductance_H = 0.0025;
  expect_independent_of_step(request);
}

TEST(Simulate, StictionHoldsOnASlopeUpToItsLimit) {
  // Held without current as long as (m g grade) r/2 is below each wheel's friction torque.
  const double holding_grade = 2 * 0.346 / 0.1 / (23.98 * kGravity_m_s2);
  for (double share : {0.98, 1.05}) {
    Robot robot = nomad();
    robot.motor.left.friction_torque_Nm = 0.346;
    SimulationRequest request = request_for(robot, {{.profile = MotionProfile::stand, .duration_s = 5}});
    request.coasting = {{0, 5}};
    request.effects = {{.name = "floor_slope",
                        .parameters = {{"grade", share * holding_grade}, {"uphill_direction_rad", 0}}}};
    const SimulationResult result = simulate(request);
    if (share < 1) {
      EXPECT_EQ(result.final_pose.x_m, 0.0);
      EXPECT_EQ(result.executed.wheel_speed_rad_s.left.back(), 0.0);
    } else {
      EXPECT_LT(result.final_pose.x_m, -0.01);
    }
  }
}

TEST(Simulate, CoastingStopsWhereFrictionHasEatenTheKineticEnergy) {
  Robot robot = nomad();
  for (Side side : kSides) robot.motor[side].viscous_friction_Nm_s_rad = 0;
  robot.motor.left.friction_torque_Nm = robot.motor.right.friction_torque_Nm = 0.35;
  const SimulationResult result =
      simulate(request_for(robot, {{.profile = MotionProfile::coast, .speed_m_s = 0.8}}));
  const double mass_kg = 21.2 + 2 * 1.39 + 2 * 0.0281 / 0.01;
  EXPECT_NEAR(result.final_pose.x_m, mass_kg * 0.8 * 0.8 / 2 / (2 * 0.35 / 0.1), 1e-7);
  EXPECT_NEAR(result.balance.motors_J, 0.0, 1e-12);
  EXPECT_TRUE(result.came_to_rest);
}

TEST(Simulate, SteadySpeedDrawsTheCurrentOfTheModel) {
  const Robot robot = nomad();
  SimulationRequest request = request_for(
      robot, {{.profile = MotionProfile::constant_speed, .speed_m_s = 0.5, .duration_s = 20}}, 8.0);
  request.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.012}}}};
  const SimulationResult result = simulate(request);
  const double rolling_Nm = 0.012 * 0.5 * (23.98 + 8.0) * kGravity_m_s2 * 0.1;
  const double expected_A = (0.3728 + 0.0017 * 5.0 + rolling_Nm) / (0.069 * 24.9);
  EXPECT_NEAR(result.log.motor_current_A.left.back(), expected_A, 1e-6);
  EXPECT_NEAR(result.log.motor_voltage_V.left.back(), 2.74 * expected_A + 0.069 * 24.9 * 5.0, 1e-6);
}

TEST(Simulate, CreepStatesApproachTheModelsCreepingContact) {
  const Robot robot = nomad();
  SimulationRequest request =
      request_for(robot, {{.profile = MotionProfile::constant_speed, .speed_m_s = 0.5, .duration_s = 10}});
  const EffectSetting drag{.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 40.0}}};
  for (double stiffness : {1000.0, 50000.0}) {  // explicit states, and the stiff limit
    request.effects = {drag, {.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", stiffness}}}};
    const SimulationResult result = simulate(request);
    const std::size_t last = result.log.size() - 1;
    const double body_m_s = (result.log.position_x_m[last] - result.log.position_x_m[last - 1]) / 0.02;
    const double wheel_m_s = 0.1 * result.log.wheel_speed_rad_s.left[last];
    const double force_N = 40.0 * body_m_s * body_m_s / 2;
    EXPECT_NEAR(wheel_m_s - body_m_s, force_N / stiffness, 1e-3 * force_N / stiffness);
  }
}

TEST(Simulate, MirroredEffectsGiveTheMirroredRun) {
  Robot robot = nomad();
  robot.motor.left.friction_torque_Nm = robot.motor.right.friction_torque_Nm = 0.36;
  SimulationRequest request = request_for(robot, {kStraight, kArc});
  request.effects = {{.name = "dragging_wheel", .parameters = {{"torque_Nm", 0.2}}, .side = Side::left}};
  const SimulationResult a = simulate(request);
  for (double& omega : request.reference.angular_speed_rad_s) omega = -omega;
  request.effects[0].side = Side::right;
  const SimulationResult b = simulate(request);
  EXPECT_NEAR(a.motor_energy_J.left, b.motor_energy_J.right, 1e-9);
  EXPECT_NEAR(a.final_pose.y_m, -b.final_pose.y_m, 1e-9);
  EXPECT_NEAR(a.final_pose.heading_rad, -b.final_pose.heading_rad, 1e-9);
}

TEST(Simulate, DriversKeepTheirLimits) {
  Robot robot = nomad();
  for (Side side : kSides) {
    robot.motor[side].max_current_A = 1.0;
    robot.motor[side].max_voltage_V = 9.0;
  }
  const SimulationResult result = simulate(request_for(
      robot,
      {{.profile = MotionProfile::trapezoid, .acceleration_m_s2 = 2, .speed_m_s = 0.9, .distance_m = 5}}));
  for (double current_A : result.executed.motor_current_A.left) EXPECT_LE(std::abs(current_A), 1.0 + 1e-12);
  for (double voltage_V : result.executed.motor_voltage_V.left) EXPECT_LE(std::abs(voltage_V), 9.0 + 1e-12);
  EXPECT_GT(result.saturated_fraction, 0.1);
}

TEST(Simulate, TheBatterySagsUnderLoadAndSaysWhereItGivesWay) {
  Robot robot = nomad();
  robot.battery.internal_resistance_ohm = 0.5;
  SimulationRequest request = request_for(robot, {kStraight}, 10.0);
  const SimulationResult result = simulate(request);
  EXPECT_FALSE(result.battery_gave_way);
  double loss_J = 0;
  for (std::size_t i = 0; i < result.log.size(); ++i) {
    const double current_A = result.log.battery_current_A[i];
    EXPECT_NEAR(result.log.battery_voltage_V[i], 25 - 0.5 * current_A, 1e-9);
    loss_J += 0.5 * current_A * current_A * 0.02;
  }
  EXPECT_NEAR(result.battery_loss_J / loss_J, 1.0, 0.01);
  EXPECT_NEAR(result.energy_J,
              result.motor_energy_J.left + result.motor_energy_J.right + 10 * result.duration_s,
              0.05 * result.energy_J);  // braking is not recovered
  request.effects = {{.name = "supply_sag", .parameters = {{"resistance_ohm", 14.0}}}};
  const SimulationResult weak = simulate(request);
  EXPECT_TRUE(weak.battery_gave_way);
  // The most power is drawn at half of the open-circuit voltage.
  for (double voltage_V : weak.log.battery_voltage_V) {
    EXPECT_GE(voltage_V, 25.0 / 2 - 1e-9);
    EXPECT_LE(voltage_V, 25.0 + 1e-9);
  }
}

TEST(Simulate, WithoutABatteryTheLogHasNoBatteryChannels) {
  Robot robot = nomad();
  robot.battery = {};
  const SimulationResult result = simulate(request_for(robot, {kStraight}));
  EXPECT_TRUE(result.log.battery_voltage_V.empty());
  EXPECT_EQ(result.battery_loss_J, 0.0);
  EXPECT_GT(result.energy_J, 0.0);
}

TEST(Simulate, InstrumentEffectsDistortTheLogOnly) {
  SimulationRequest request = request_for(nomad(), kTour);
  const SimulationResult plain = simulate(request);
  request.effects = {{.name = "current_sensor_offset", .parameters = {{"offset_A", 0.1}}, .side = Side::left},
                     {.name = "time_misalignment", .parameters = {{"delay_s", 0.04}}}};
  const SimulationResult distorted = simulate(request);
  EXPECT_EQ(plain.energy_J, distorted.energy_J);
  EXPECT_EQ(plain.final_pose.x_m, distorted.final_pose.x_m);
  EXPECT_EQ(plain.log.wheel_speed_rad_s.left, distorted.log.wheel_speed_rad_s.left);
  EXPECT_NEAR(distorted.log.motor_current_A.left[102], plain.log.motor_current_A.left[100] + 0.1, 1e-9);
}

TEST(Simulate, NoiseHasItsSizeAndComesFromTheSeed) {
  SimulationRequest request =
      request_for(nomad(), {{.profile = MotionProfile::constant_speed, .speed_m_s = 0.5, .duration_s = 40}});
  request.sensors.current_noise_A = 0.02;
  const SimulationResult a = simulate(request);
  const SimulationResult again = simulate(request);
  request.seed = 2;
  const SimulationResult b = simulate(request);
  EXPECT_EQ(a.log.motor_current_A.left, again.log.motor_current_A.left);
  EXPECT_NE(a.log.motor_current_A.left, b.log.motor_current_A.left);
  double sum = 0;
  for (std::size_t i = 0; i < a.log.size(); ++i) {
    const double difference = a.log.motor_current_A.left[i] - b.log.motor_current_A.left[i];
    sum += difference * difference;
  }
  EXPECT_NEAR(std::sqrt(sum / (2.0 * static_cast<double>(a.log.size()))), 0.02, 0.002);
}

TEST(Simulate, LoggedMeansAddUpToTheEnergy) {
  // At constant speed and voltage the means carry the whole energy; readings are exact means.
  const SimulationResult result = simulate(request_for(nomad(), {kStraight}));
  double charge_As = 0;
  for (double current_A : result.log.motor_current_A.left) charge_As += 0.02 * current_A;
  double turned_rad = 0;
  for (double speed : result.log.wheel_speed_rad_s.left) turned_rad += 0.02 * speed;
  EXPECT_NEAR(turned_rad, 4 / 0.1, 0.02);
  EXPECT_NEAR(0.1 * turned_rad, result.final_pose.x_m, 1e-3);
  EXPECT_GT(charge_As, 0.0);
}

TEST(Simulate, AReferenceWithoutSpeedsIsRefused) {
  SimulationRequest request{.robot = nomad()};
  EXPECT_THROW((void)simulate(request), ConfigError);
  request.reference.time_s = {0, 1};
  EXPECT_THROW((void)simulate(request), ConfigError);
}

/// With an integral gain alone the voltage is the integral. At rest it decays with 0.1 s; a wheel that still
/// turns keeps it, but for the speed error of one period.
TEST(WheelController, KeepsItsIntegralUntilTheWheelsStand) {
  constexpr double kGain_V_rad = 1.0, kPeriod_s = 0.01, kTurning_rad_s = 0.5;
  const auto stopped_V = [&](double wheel_rad_s) {
    WheelController controller({.period_s = kPeriod_s,
                                .proportional_V_s_rad = 0.0,
                                .integral_V_rad = kGain_V_rad,
                                .feed_forward = false},
                               testing::nomad());
    double before_V = 0;
    for (int i = 0; i < 100; ++i)
      before_V = controller.command_V({.speed_m_s = 1.0}, {}, {0.0, 0.0}, {24.0, 24.0}).left;
    EXPECT_NEAR(before_V, 100 * kGain_V_rad * (1.0 / 0.1) * kPeriod_s, 1e-9);
    return controller.command_V({}, {}, {wheel_rad_s, wheel_rad_s}, {24.0, 24.0}).left / before_V;
  };
  EXPECT_NEAR(stopped_V(0.0), std::exp(-kPeriod_s / 0.1), 1e-9);
  EXPECT_NEAR(stopped_V(kTurning_rad_s), 1.0 - kGain_V_rad * kTurning_rad_s * kPeriod_s / 10.0, 2e-3);
}

}  // namespace
}  // namespace joulepath
