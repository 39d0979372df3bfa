// The first estimate of the delay of voltages and currents, from logs whose channels are moved by whole
// samples.
#include "diagnosis/evidence/delay_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr double kLogPeriod_s = 0.02;

/// A drive whose electrical channels show what was `samples` samples ago.
Dataset late_by(long samples) {
  Run run = testing::synthetic_run(testing::nomad(), "run", 20, 0, testing::swinging(0.5, 0.3, 2.5, 0.4, 1.7),
                                   {}, 1, kLogPeriod_s);
  const auto moved = [&](std::vector<double>& values) {
    const std::vector<double> exact = values;
    const long last = std::ssize(exact) - 1;
    for (long k = 0; k <= last; ++k)
      values[static_cast<std::size_t>(k)] =
          exact[static_cast<std::size_t>(std::clamp(k - samples, 0L, last))];
  };
  for (Side side : kSides) moved(run.log.motor_voltage_V[side]), moved(run.log.motor_current_A[side]);
  return {.robot = testing::nomad(), .runs = {run}};
}

TEST(DelaySearch, FindsLateAndEarlyChannels) {
  for (const long samples : {-4L, 0L, 5L, 12L}) {
    const Dataset dataset = late_by(samples);
    EXPECT_NEAR(rough_channel_delay_s({.dataset = &dataset, .runs = {0}}),
                static_cast<double>(samples) * kLogPeriod_s, 1e-9)
        << samples;
  }
}

// V - R i of a wrong R changes with the acceleration, as a shift of the speed does.
TEST(DelaySearch, TakesNoConstantOfTheFileForAShift) {
  for (const double factor : {1 / 1.6, 1.6})
    for (double Motor::*constant : {&Motor::resistance_ohm, &Motor::voltage_constant_V_s_rad})
      for (const long samples : {0L, 5L}) {
        Dataset dataset = late_by(samples);
        for (Side side : kSides) dataset.robot.motor[side].*constant *= factor;
        EXPECT_NEAR(rough_channel_delay_s({.dataset = &dataset, .runs = {0}}),
                    static_cast<double>(samples) * kLogPeriod_s, 1e-9)
            << factor << ' ' << samples;
      }
}

/// Noise of the current, which the winding's resistance multiplies, is no shift. By least squares of the
/// voltage a smaller resistance with a shift leaves less than the true one without.
TEST(DelaySearch, TakesNoNoiseOfTheCurrentForAShift) {
  Robot robot = testing::nomad();
  for (Side side : kSides) robot.motor[side].resistance_ohm *= 10;
  for (const unsigned seed : {1U, 2U, 3U}) {
    Dataset dataset{.robot = robot};
    dataset.runs.push_back(testing::synthetic_run(robot, "run", 20, 0, testing::swinging(0.5, 0.1, 0.8),
                                                  {0.005, 0.2, 0.01}, seed, kLogPeriod_s));
    EXPECT_EQ(rough_channel_delay_s({.dataset = &dataset, .runs = {0}}), 0.0) << seed;
  }
}

TEST(DelaySearch, NeedsVoltages) {
  Dataset dataset = late_by(5);
  dataset.runs[0].log.motor_voltage_V = {};
  EXPECT_EQ(rough_channel_delay_s({.dataset = &dataset, .runs = {0}}), 0.0);
  EXPECT_EQ(rough_channel_delay_s({.dataset = &dataset}), 0.0);
}

}  // namespace
}  // namespace joulepath
