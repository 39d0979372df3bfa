#include "model/estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "model/config_error.hpp"
#include "model/local_fit.hpp"
#include "model/sampled_motion.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

SimulationResult noisy_run(const Robot& robot, std::uint64_t seed) {
  const std::vector<PrescribedMotion> tour{
      {.profile = MotionProfile::stand, .duration_s = 3},
      {.profile = MotionProfile::trapezoid, .speed_m_s = 0.7, .distance_m = 6},
      {.profile = MotionProfile::arc, .speed_m_s = 0.5, .radius_m = 1.0, .angle_rad = 3.0},
      {.profile = MotionProfile::stand, .duration_s = 3}};
  SimulationRequest request{.robot = robot, .seed = seed};
  request.reference = timed_motion(robot, tour, {.payload_kg = 5}).trajectory;
  request.sensors = typical_sensors();
  return simulate(request);
}

TEST(LocalFit, ParabolasPassUnchanged) {
  std::vector<double> time_s, values;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.02 * i + 0.003 * (i % 3);
    time_s.push_back(t);
    values.push_back(1 - 2 * t + 3 * t * t);
  }
  const LocalFit fit = fit_locally(time_s, values, 0.1);
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    EXPECT_NEAR(fit.value[i], values[i], 1e-12);
    EXPECT_NEAR(fit.slope[i], -2 + 6 * time_s[i], 1e-9);
  }
}

/// Samples further apart than the reach: each is fitted with its two neighbors.
TEST(LocalFit, SparseSamplesAreFittedWithTheirNeighbors) {
  const std::vector<double> time_s{0, 1, 2.5, 3, 5};
  std::vector<double> values;
  for (double t : time_s) values.push_back(1 - 2 * t + 3 * t * t);
  const LocalFit fit = fit_locally(time_s, values, 0.1);
  for (std::size_t i = 1; i + 1 < time_s.size(); ++i) {
    EXPECT_NEAR(fit.value[i], values[i], 1e-9);
    EXPECT_NEAR(fit.slope[i], -2 + 6 * time_s[i], 1e-9);
  }
}

TEST(SampledMotion, TheTimeOfDayGoesOnWithTheLog) {
  const Trajectory log{
      .time_s = {5, 6, 8}, .linear_speed_m_s = {0, 0.5, 0.5}, .angular_speed_rad_s = {0, 0, 0}};
  const Plant plant = make_plant(nomad());
  const SampledMotion motion(plant, log, {.time_of_day_s = 100});
  EXPECT_NEAR(motion.at(7.5).site.time_of_day_s, 102.5, 1e-12);
}

TEST(LocalFit, NoiseIsSeparatedFromMotion) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.01);
  std::vector<double> values;
  for (int i = 0; i < 4000; ++i) values.push_back(std::sin(0.01 * i) + normal(random));
  EXPECT_NEAR(noise_of(values), 0.01, 0.001);
}

TEST(Estimate, ConstantSpeedCostsPowerTimesTime) {
  Trajectory log;
  for (int i = 0; i <= 100; ++i) {
    log.time_s.push_back(0.1 * i);
    log.linear_speed_m_s.push_back(0.5);
    log.angular_speed_rad_s.push_back(0.0);
  }
  const EnergyEstimate estimate = estimate_energy(make_plant(nomad()), log);
  const double current_A = (0.3728 + 0.0017 * 5) / (0.069 * 24.9);
  EXPECT_NEAR(estimate.motor_J.left, 10 * current_A * (2.74 * current_A + 0.069 * 24.9 * 5), 1e-9);
  EXPECT_NEAR(estimate.by_cause.total_J(), estimate.motor_J.left + estimate.motor_J.right + 100, 1e-9);
  EXPECT_NEAR(estimate.distance_m, 5.0, 1e-12);
}

TEST(Estimate, BodySpeedsAndWheelSpeedsGiveTheSameEnergy) {
  const SimulationResult run = noisy_run(nomad(), 1);
  Trajectory wheels = run.log;
  wheels.linear_speed_m_s.clear();
  Trajectory body;
  body.time_s = wheels.time_s;
  body.payload_kg = wheels.payload_kg;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const auto twist = body_twist(
        nomad().geometry, Sided<double>{wheels.wheel_speed_rad_s.left[i], wheels.wheel_speed_rad_s.right[i]});
    body.linear_speed_m_s.push_back(twist.speed_m_s);
    body.angular_speed_rad_s.push_back(twist.yaw_rate_rad_s);
  }
  const Plant plant = make_plant(nomad());
  EXPECT_NEAR(estimate_energy(plant, wheels).motor_J.left, estimate_energy(plant, body).motor_J.left, 1e-9);
}

TEST(Estimate, NoisyOdometryGivesTheMeasuredEnergyWithinAPercent) {
  for (std::uint64_t seed : {1, 2, 3}) {
    const SimulationResult run = noisy_run(nomad(), seed);
    const EnergyEstimate estimate = estimate_energy(make_plant(nomad()), run.log);
    const auto measured = measured_motor_energy_J(run.log, 1.0);
    ASSERT_TRUE(measured);
    EXPECT_GT(estimate.reach_s, 0.0);
    for (Side side : kSides) {
      EXPECT_NEAR(estimate.motor_J[side] / run.motor_energy_J[side], 1.0, 0.01);
      EXPECT_NEAR((*measured)[side] / run.motor_energy_J[side], 1.0, 0.01);
    }
    EXPECT_NEAR(estimate.by_cause.total_J() / *measured_battery_energy_J(run.log), 1.0, 0.01);
  }
}

TEST(Estimate, StandingDrawsStandbyOnlyInSpiteOfNoise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.01);
  Trajectory log;
  for (int i = 0; i < 500; ++i) {
    log.time_s.push_back(0.02 * i);
    for (Side side : kSides) log.wheel_speed_rad_s[side].push_back(normal(random));
  }
  const EnergyEstimate estimate = estimate_energy(make_plant(nomad()), log);
  EXPECT_NEAR(estimate.by_cause.total_J(), 10.0 * log.time_s.back(), 0.05);
}

TEST(Estimate, ARobotThatStandsOnASlopeIsHeldByFrictionNotByItsMotors) {
  const Plant plant = make_plant(
      nomad(), {{.name = "floor_slope", .parameters = {{"grade", 0.02}, {"uphill_direction_rad", 0}}}});
  const Trajectory log =
      timed_motion(nomad(), {{.profile = MotionProfile::stand, .duration_s = 5}}).trajectory;
  const EnergyEstimate estimate = estimate_energy(plant, log);
  EXPECT_EQ(estimate.motor_J.left, 0.0);
  EXPECT_NEAR(estimate.by_cause.total_J(), 50.0, 1e-9);
}

/// S-bends: casters swivel all the time. With the smoothing of noisy logs their energy stays the same.
TEST(Estimate, CastersTakeTheSameWithAndWithoutSmoothing) {
  const Plant plant =
      make_plant(nomad(), {{.name = "caster_swivel", .parameters = {{"moment_Nm", 2.0}, {"trail_m", 0.1}}}});
  Trajectory log;
  for (int i = 0; i <= 2000; ++i) {
    log.time_s.push_back(0.01 * i);
    log.linear_speed_m_s.push_back(0.4);
    log.angular_speed_rad_s.push_back(0.8 * std::sin(0.02 * i));
  }
  const double exact_J = estimate_energy(plant, log, {.reach_s = 0.0}).by_cause.effects_J.at("caster_swivel");
  const double smoothed_J =
      estimate_energy(plant, log, {.reach_s = 0.03}).by_cause.effects_J.at("caster_swivel");
  EXPECT_GT(exact_J, 0.5);
  EXPECT_NEAR(smoothed_J / exact_J, 1.0, 0.01);
}

TEST(Estimate, BrakingCountsAsTheRobotRegenerates) {
  Robot robot = nomad();
  SimulationRequest request{.robot = robot};
  request.reference = timed_motion(robot,
                                   {{.profile = MotionProfile::trapezoid,
                                     .deceleration_m_s2 = 0.8,
                                     .speed_m_s = 1.0,
                                     .distance_m = 4}},
                                   {.payload_kg = 10})
                          .trajectory;
  const EnergyEstimate none = estimate_energy(make_plant(robot), request.reference);
  robot.power.regeneration_efficiency = 1.0;
  const EnergyEstimate all = estimate_energy(make_plant(robot), request.reference);
  EXPECT_EQ(none.motor_J.left, all.motor_J.left);
  EXPECT_NEAR(all.counted_J.left, all.motor_J.left, 1e-12);
  EXPECT_GT(none.counted_J.left, all.counted_J.left + 0.1);
}

TEST(Estimate, UncertaintyOfStandbyAloneIsStandbysShare) {
  Robot robot = nomad();
  robot.uncertainty = {{"standby_W", 0.1}};
  robot.battery.internal_resistance_ohm = 0;
  const SimulationResult run = noisy_run(robot, 1);
  EXPECT_NEAR(energy_sigma_J(robot, run.log), 0.1 * 10 * (run.log.time_s.back() - run.log.time_s.front()),
              1e-6);
  robot.uncertainty = {};
  EXPECT_EQ(energy_sigma_J(robot, run.log), 0.0);
}

TEST(Estimate, ALogWithoutSpeedsIsRefused) {
  Trajectory log{.time_s = {0, 1}};
  EXPECT_THROW((void)estimate_energy(make_plant(nomad()), log), ConfigError);
}

/// The trapezoidal rule on uneven rows.
TEST(Estimate, MeasuredEnergyIsExactForPowerThatIsLinearBetweenRows) {
  Trajectory log;
  log.time_s = {0, 1, 3};
  log.motor_power_W = {{7, 10, 20}, {1, 1, 1}};
  const auto energy_J = measured_motor_energy_J(log, 1.0);
  ASSERT_TRUE(energy_J.has_value());
  EXPECT_NEAR(energy_J->left, 8.5 + 30.0, 1e-12);
  EXPECT_NEAR(energy_J->right, 3.0, 1e-12);
}

}  // namespace
}  // namespace joulepath
