#include "diagnosis/calibration/steady.hpp"

#include <gtest/gtest.h>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath::calibration {
namespace {

using testing::constant_speed;
using testing::nomad;
using testing::swinging;
using testing::synthetic_run;

Dataset steady_dataset(const Robot& truth) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  for (int k = 1; k <= 9; ++k)
    dataset.runs.push_back(synthetic_run(truth, "run_" + std::to_string(k), 8, 0, constant_speed(0.1 * k)));
  return dataset;
}

TEST(SteadyCalibration, GivesTheFrictionOfConstantSpeedsBack) {
  Robot truth = nomad();
  truth.motor.left.friction_torque_Nm = 0.4;
  truth.motor.right.viscous_friction_Nm_s_rad = 0.0025;
  const CalibrationResult result = calibrate(steady_dataset(truth), CalibrationMethod::steady);
  EXPECT_NEAR(result.robot.motor.left.friction_torque_Nm, 0.4, 1e-8);
  EXPECT_NEAR(result.robot.motor.right.friction_torque_Nm, 0.346, 1e-8);
  EXPECT_NEAR(result.robot.motor.left.viscous_friction_Nm_s_rad, 0.0017, 1e-8);
  EXPECT_NEAR(result.robot.motor.right.viscous_friction_Nm_s_rad, 0.0025, 1e-8);
}

TEST(SteadyCalibration, FitsEquation30OfThePaper) {
  const CalibrationResult result = calibrate(steady_dataset(nomad()), CalibrationMethod::steady);
  const SteadyLine& left = result.lines.value().left;
  const double K = 24.9 * 0.069;
  EXPECT_NEAR(left.b1_A, 0.3728 / K, 1e-9);
  EXPECT_NEAR(left.b2_A_s_rad, 0.0017 / K, 1e-9);
  EXPECT_NEAR(left.c1_V, 2.74 * 0.3728 / K, 1e-9);
  EXPECT_NEAR(left.c2_V_s_rad, 2.74 * 0.0017 / K + K, 1e-9);
}

TEST(SteadyCalibration, ReadsReverseRunsWithTheSameFriction) {
  Dataset dataset = steady_dataset(nomad());
  for (int k = 1; k <= 5; ++k)
    dataset.runs.push_back(
        synthetic_run(nomad(), "back_" + std::to_string(k), 8, 0, constant_speed(-0.1 * k)));
  const CalibrationResult result = calibrate(dataset, CalibrationMethod::steady);
  EXPECT_NEAR(result.robot.motor.left.friction_torque_Nm, 0.3728, 1e-8);
}

/// Accelerates for 4 s, holds 0.8 m/s for 6 s, brakes for 4 s.
BodyMotion<double> trapezoid(double t) {
  if (t < 4) return {.speed_m_s = 0.2 * t, .acceleration_m_s2 = 0.2};
  if (t < 10) return {.speed_m_s = 0.8};
  return {.speed_m_s = std::max(0.0, 0.8 - 0.2 * (t - 10)), .acceleration_m_s2 = t < 14 ? -0.2 : 0.0};
}

TEST(SteadySegments, AreTheCruiseOfATrapezoidAlone) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  dataset.runs.push_back(synthetic_run(nomad(), "run", 14, 0, trapezoid, {0.02, 0.01, 0.02}));
  const std::vector<SteadySegment> segments = find_steady_segments(smooth_runs(dataset));
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_GE(segments[0].start_s, 3.8);
  EXPECT_LE(segments[0].start_s + segments[0].duration_s, 10.2);
  EXPECT_GT(segments[0].duration_s, 4.5);
  EXPECT_NEAR(segments[0].speed_rad_s.left, 8.0, 0.02);
}

TEST(SteadySegments, LeaveTurnsOut) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  dataset.runs.push_back(synthetic_run(nomad(), "circle", 10, 0, [](double) {
    return BodyMotion<double>{.speed_m_s = 0.5, .yaw_rate_rad_s = 0.5};
  }));
  EXPECT_TRUE(find_steady_segments(smooth_runs(dataset)).empty());
}

TEST(SteadySegments, EndAtGaps) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  joulepath::Run run = synthetic_run(nomad(), "run", 20, 0, constant_speed(0.5));
  for (std::size_t k = 500; k < run.log.time_s.size(); ++k) run.log.time_s[k] += 30;
  dataset.runs.push_back(run);
  const std::vector<SteadySegment> segments = find_steady_segments(smooth_runs(dataset));
  ASSERT_EQ(segments.size(), 2u);
  for (const SteadySegment& segment : segments) EXPECT_LT(segment.duration_s, 11);
}

TEST(SteadyCalibration, RefusesOneSpeedAndSaysWhy) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  for (int k = 0; k < 6; ++k)
    dataset.runs.push_back(synthetic_run(nomad(), "run_" + std::to_string(k), 8, 0, constant_speed(0.5)));
  try {
    (void)calibrate(dataset, CalibrationMethod::steady);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("two speeds"), std::string::npos) << error.what();
  }
}

TEST(SteadyCalibration, RefusesRunsThatNeverHoldTheirSpeed) {
  Dataset dataset{.file = "dataset.yaml", .robot = nomad()};
  dataset.runs.push_back(synthetic_run(nomad(), "run", 10, 0, swinging(0.5, 0.3, 2.0)));
  EXPECT_THROW((void)calibrate(dataset, CalibrationMethod::steady), ConfigError);
}

std::string refusal(const Dataset& dataset) {
  try {
    (void)calibrate(dataset, CalibrationMethod::full);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Calibration, SaysWhichChannelIsMissing) {
  Dataset dataset = steady_dataset(nomad());
  for (joulepath::Run& run : dataset.runs) run.log.motor_current_A = {};
  EXPECT_NE(refusal(dataset).find("no run with motor currents"), std::string::npos) << refusal(dataset);
  dataset = steady_dataset(nomad());
  for (joulepath::Run& run : dataset.runs) run.log.wheel_speed_rad_s = {};
  EXPECT_NE(refusal(dataset).find("no run with wheel speeds"), std::string::npos) << refusal(dataset);
  dataset.runs.clear();
  dataset.runs.push_back(joulepath::Run{.motion = PrescribedMotion{}});
  EXPECT_NE(refusal(dataset).find("no run with a log"), std::string::npos) << refusal(dataset);
}

TEST(Calibration, RefusesARobotWithEffectsAndRunsAtRest) {
  Dataset dataset = steady_dataset(nomad());
  dataset.robot.effects.push_back({.name = "rolling_resistance", .parameters = {{"coefficient", 0.01}}});
  EXPECT_NE(refusal(dataset).find("effects"), std::string::npos);
  dataset = Dataset{.file = "dataset.yaml", .robot = nomad()};
  dataset.runs.push_back(synthetic_run(nomad(), "rest", 10, 0, constant_speed(0.0)));
  EXPECT_NE(refusal(dataset).find("0.3 rad/s"), std::string::npos) << refusal(dataset);
}

}  // namespace
}  // namespace joulepath::calibration
