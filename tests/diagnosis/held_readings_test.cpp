// Logs whose channels repeat their readings: devices that are slower than the log, each with its own clock.
#include "diagnosis/signals/held_readings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/local_fit.hpp"
#include "tests/support/blind_day.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::blind_day;
using testing::have_blind_plant;

/// Readings `period` samples apart, which need not be a whole number.
void repeat_readings(std::vector<double>& channel, double period) {
  const std::vector<double> read = channel;
  for (std::size_t i = 0; i < channel.size(); ++i)
    channel[i] = read[static_cast<std::size_t>(std::floor(std::floor(double(i) / period) * period))];
}

enum Repeating { kWheelsHold = 1, kDriverHolds = 2, kPoseHolds = 4, kGyroHolds = 8 };

Dataset with_held(Dataset dataset, int devices, double period) {
  for (joulepath::Run& run : dataset.runs) {
    Trajectory& log = run.log;
    for (Side side : kSides) {
      if (devices & kWheelsHold) repeat_readings(log.wheel_speed_rad_s[side], period);
      if (devices & kDriverHolds)
        repeat_readings(log.motor_voltage_V[side], period),
            repeat_readings(log.motor_current_A[side], period);
    }
    if (devices & kPoseHolds)
      repeat_readings(log.position_x_m, period), repeat_readings(log.position_y_m, period);
    if (devices & kPoseHolds) repeat_readings(log.heading_rad, period);
    if (devices & kGyroHolds) repeat_readings(log.gyro_yaw_rate_rad_s, period);
  }
  return dataset;
}

TEST(HeldReadings, AreNoGap) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = blind_day("none", 0, 0, 12, 901);
  for (const double period : {3.0, 2.5})
    for (const int devices :
         {kWheelsHold + 0, kDriverHolds + 0, kWheelsHold + kDriverHolds, kPoseHolds + 0, kGyroHolds + 0}) {
      const Diagnosis d = diagnose(with_held(day, devices, period), {.bootstrap = 0});
      EXPECT_EQ(d.verdict, Verdict::no_gap)
          << verdict_name(d.verdict) << ": devices " << devices << " every " << period << " samples";
    }
}

TEST(HeldReadings, LeaveACauseItsSize) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = blind_day("viscous_friction", 0.008, 0, 12, 902);
  for (const int devices : {kWheelsHold + 0, kWheelsHold + kDriverHolds, kPoseHolds + 0}) {
    const Diagnosis d = diagnose(with_held(day, devices, 3), {.bootstrap = 0});
    ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict) << ": devices " << devices;
    EXPECT_EQ(d.causes[0].effect.name, "viscous_friction");
    EXPECT_NEAR(d.causes[0].parameters[0].value, 0.008, 0.0008);
  }
}

/// Between readings lie lines; a value that stays was read again.
TEST(HeldReadings, AreDrawnAsLines) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> read(400);
  for (std::size_t i = 0; i < read.size(); ++i) read[i] = i < 200 ? normal(random) : 3.0;
  read[399] = 4.0;
  std::vector<double> held = read;
  repeat_readings(held, 4);
  EXPECT_EQ(hold_of(held), 4u);
  Dataset dataset{.runs = {{.name = "held"}}};
  for (std::size_t i = 0; i < held.size(); ++i)
    dataset.runs[0].log.time_s.push_back(0.02 * static_cast<double>(i));
  dataset.runs[0].log.gyro_yaw_rate_rad_s = held;
  EXPECT_TRUE(holds_readings(dataset));
  const std::vector<double> lines = between_readings(dataset).runs[0].log.gyro_yaw_rate_rad_s;
  for (std::size_t i = 4; i + 4 < 200; i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(lines[i + k], read[i] + (read[i + 4] - read[i]) * double(k) / 4, 1e-12) << i + k;
  for (std::size_t i = 204; i < 396; ++i) EXPECT_EQ(lines[i], 3.0) << i;
}

/// A heading that turns steadily changes in steps that are all alike, as if it were rounded. It comes with
/// positions that are held, and is read as they are.
TEST(HeldReadings, OfAPoseAreThoseOfAllItsChannels) {
  std::mt19937 random(10);
  std::normal_distribution<double> normal(0, 0.002);
  Dataset dataset{.runs = {{.name = "turns in place"}}};
  Trajectory& log = dataset.runs[0].log;
  for (std::size_t i = 0; i < 400; ++i) {
    log.time_s.push_back(0.02 * static_cast<double>(i));
    log.position_x_m.push_back(normal(random));
    log.position_y_m.push_back(normal(random));
    log.heading_rad.push_back(std::remainder(0.01 * static_cast<double>(i), 2 * std::numbers::pi));
  }
  for (auto* channel : {&log.position_x_m, &log.position_y_m, &log.heading_rad})
    repeat_readings(*channel, 2.5);
  EXPECT_EQ(hold_of(log.heading_rad), 1u);
  EXPECT_EQ(hold_of(log.position_x_m), 2u);
  const std::vector<double> heading_rad = between_readings(dataset).runs[0].log.heading_rad;
  for (std::size_t i = 10; i < 390; ++i) EXPECT_NEAR(heading_rad[i + 1] - heading_rad[i], 0.01, 0.006) << i;
}

/// A pose that rows hold two and three times by turns has one period in all runs, whichever of the two comes
/// more often.
TEST(HeldReadings, HaveThePeriodOfTheirInstrument) {
  const Robot robot = testing::nomad();
  for (const double length_s : {10.0, 10.02, 10.04, 10.06}) {
    joulepath::Run run =
        testing::synthetic_run(robot, "held", length_s, 0.0, testing::swinging(0.5, 0.2, 1.1));
    double way_m = 0;
    for (const double speed_rad_s : run.log.wheel_speed_rad_s.left)
      run.log.position_x_m.push_back(way_m += 0.02 * robot.geometry.wheel_radius_m.left * speed_rad_s);
    run.log.position_y_m = run.log.position_x_m;
    repeat_readings(run.log.position_x_m, 2.5), repeat_readings(run.log.position_y_m, 2.5);
    EXPECT_NEAR(make_run_signals(run, 0, robot).reading_period_s.pose_s, 2.5 * 0.02, 0.0005) << length_s;
  }
}

/// Between lines the noise is that of the readings.
TEST(HeldReadings, HaveTheirNoiseOnLines) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<double> channel(3000);
  for (double& value : channel) value = 0.1 * normal(random);
  repeat_readings(channel, 3);
  Dataset dataset{.runs = {{.name = "held"}}};
  Trajectory& log = dataset.runs[0].log;
  for (std::size_t i = 0; i < channel.size(); ++i) log.time_s.push_back(0.02 * static_cast<double>(i));
  log.gyro_yaw_rate_rad_s = channel;
  EXPECT_NEAR(noise_of_readings(between_readings(dataset).runs[0].log.gyro_yaw_rate_rad_s), 0.1, 0.01);
}

/// Noise, steps of rounding and a channel at rest hold nothing.
TEST(HeldReadings, AreNotSeenInOtherChannels) {
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  std::vector<double> noise(500), rounded(500), slow(500), encoder(500);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const double t = 0.02 * static_cast<double>(i);
    noise[i] = normal(random);
    rounded[i] = std::round(20 * std::sin(0.8 * t)) / 20;
    slow[i] = std::round(57.3 * 0.3 * t);  // a heading in whole degrees
    encoder[i] = std::floor(40 * std::sin(t) + normal(random)) * 0.1;
  }
  for (const auto& channel : {noise, rounded, slow, encoder, std::vector<double>(500, 1.0)})
    EXPECT_EQ(hold_of(channel), 1u);
}

}  // namespace
}  // namespace joulepath
