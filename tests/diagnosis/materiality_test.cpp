// How much of a user's results an effect changes: shares of power, final heading, final place.
#include "diagnosis/evidence/materiality.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// Straight drives at 0.5 m/s.
std::vector<RunSignals> straight_runs(const std::vector<double>& durations_s) {
  std::vector<RunSignals> signals;
  for (const double duration_s : durations_s)
    signals.push_back(make_run_signals(
        testing::synthetic_run(testing::nomad(), "lane", duration_s, 0, testing::constant_speed(0.5)),
        signals.size(), testing::nomad()));
  return signals;
}

Robot with_radius(double left_factor, double right_factor) {
  Robot robot = testing::nomad();
  robot.geometry.wheel_radius_m.left *= left_factor;
  robot.geometry.wheel_radius_m.right *= right_factor;
  return robot;
}

TEST(Materiality, OfPowerIsTheShareOfTheSumOverRuns) {
  const std::vector<RunSignals> signals = straight_runs({5, 20});
  Robot worn = testing::nomad();
  worn.motor.left.friction_torque_Nm *= 1.2;
  double change_W = 0, sum_W = 0;
  for (const RunSignals& run : signals) {
    const Prediction with_it = predict(run, {.robot = worn}),
                     without = predict(run, {.robot = testing::nomad()});
    for (Side side : kSides) {
      change_W += (with_it.power_W[side] - without.power_W[side]).cwiseAbs().sum();
      sum_W += without.power_W[side].cwiseAbs().sum();
    }
  }
  const Impact impact = impact_between(signals, {.robot = worn}, {.robot = testing::nomad()});
  EXPECT_GT(impact.motor_power, 0.01);
  EXPECT_NEAR(impact.motor_power, change_W / sum_W, 1e-12);
  EXPECT_EQ(impact.battery_power, 0.0) << "no such channel";
  EXPECT_EQ(impact.heading_rad, 0.0);
}

/// One wheel another 1 % larger turns the robot by 0.01 v t/(2 l); both 2 % larger move its end by 2 % of the
/// way. The longest run counts.
TEST(Materiality, OfMotionIsTheGreatestChangeAtTheEndOfARun) {
  const std::vector<RunSignals> signals = straight_runs({5, 20});
  const double time_s = signals[1].time_s[signals[1].size() - 1] - signals[1].time_s[0];
  const Impact turned =
      impact_between(signals, {.robot = with_radius(1, 1.03)}, {.robot = with_radius(1, 1.02)});
  const double expected_rad = 0.01 * 0.5 * time_s / (2 * testing::nomad().geometry.half_track_m);
  EXPECT_NEAR(turned.heading_rad, expected_rad, 0.02 * expected_rad);
  const Impact smaller =
      impact_between(signals, {.robot = with_radius(0.98, 0.98)}, {.robot = testing::nomad()});
  EXPECT_NEAR(smaller.position, 0.02, 0.001);
  EXPECT_NEAR(smaller.heading_rad, 0.0, 1e-9);
}

TEST(Materiality, IsTheGreatestRatioToTheFloor) {
  EXPECT_EQ(materiality({}), 0.0);
  EXPECT_NEAR(materiality({.motor_power = 2 * kMaterialEnergy}), 2, 1e-12);
  EXPECT_NEAR(materiality({.battery_power = 3 * kMaterialEnergy}), 3, 1e-12);
  EXPECT_NEAR(materiality({.battery_voltage_V = kMaterialVoltage_V}), 1, 1e-12);
  EXPECT_NEAR(materiality({.heading_rad = kMaterialHeading_rad}), 1, 1e-12);
  EXPECT_NEAR(materiality({.position = kMaterialPosition}), 1, 1e-12);
  EXPECT_NEAR(materiality({.motor_power = kMaterialEnergy, .delay_samples = 5 * kMaterialDelay_samples}), 5,
              1e-12);
}

TEST(LeastAmplitude, IsJustMaterial) {
  const Robot robot = testing::nomad();
  const std::vector<RunSignals> signals = straight_runs({10});
  const Candidate friction = bare_candidate(*find_effect("coulomb_friction"), robot);
  std::map<std::string, double> known;
  const std::vector<double> least = least_amplitudes(signals, robot, {}, {}, {friction}, known);
  std::vector<double> amplitude(friction.amplitude.size(), 0.0);
  amplitude[0] = least[0];
  const ModelState with_it{.effects = {{friction, amplitude}}};
  EXPECT_NEAR(materiality(impact_between(signals, model_point(robot, {}, with_it), {.robot = robot})), 1.0,
              0.1);
  EXPECT_EQ(known.size(), 1u);
}

}  // namespace
}  // namespace joulepath
