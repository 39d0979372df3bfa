// The direction of a motor's current under the smoothing kernel, and what depends on it: a driver's voltage
// drop acts in each sample, not in their mean.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/checks/foreign_robot.hpp"
#include "diagnosis/evidence/delay_search.hpp"
#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// Starts, brakes within `ramp_s` and rests, again and again, every other time backward: the current changes
/// its sign twice in each cycle.
testing::MotionLaw starting_and_braking(double speed_m_s, double ramp_s) {
  return [=](double t) {
    const double cycle_s = 2 * ramp_s + 1.5, at_s = std::fmod(t, cycle_s), brake_s = ramp_s + 0.8;
    const double sign = std::fmod(t, 2 * cycle_s) < cycle_s ? 1.0 : -1.0, rate = speed_m_s / ramp_s;
    BodyMotion<double> motion;
    if (at_s < ramp_s)
      motion.speed_m_s = rate * at_s, motion.acceleration_m_s2 = rate;
    else if (at_s < brake_s)
      motion.speed_m_s = speed_m_s;
    else if (at_s < brake_s + ramp_s)
      motion.speed_m_s = rate * (brake_s + ramp_s - at_s), motion.acceleration_m_s2 = -rate;
    motion.speed_m_s *= sign, motion.acceleration_m_s2 *= sign;
    return motion;
  };
}

/// Runs of a robot with a drop; the file has none.
Dataset with_drop(double drop_V, double resistance_factor = 1) {
  Dataset dataset{.robot = testing::nomad()};
  for (Side side : kSides) dataset.robot.motor[side].resistance_ohm *= resistance_factor;
  Robot real = dataset.robot;
  if (drop_V > 0) real.effects = {{.name = "driver_voltage_drop", .parameters = {{"voltage_V", drop_V}}}};
  for (unsigned r = 0; r < 8; ++r)
    dataset.runs.push_back(testing::synthetic_run(real, "run_" + std::to_string(r), 20, r % 2 == 0 ? 0 : 8,
                                                  starting_and_braking(0.3 + 0.05 * r, 0.25 + 0.05 * (r % 4)),
                                                  {0.002, 0.01, 0.01}, r + 1));
  return dataset;
}

std::vector<RunSignals> signals_of(const Dataset& dataset) {
  std::vector<RunSignals> signals;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    signals.push_back(make_run_signals(dataset.runs[r], r, dataset.robot));
  return signals;
}

/// A plain regression of the smoothed voltages, which knows nothing of the diagnosis, finds the drop and the
/// winding.
TEST(CurrentDirection, IsTheColumnOfADriversDrop) {
  const Dataset dataset = with_drop(0.3);
  std::vector<Eigen::Vector3d> columns;
  std::vector<double> voltage_V;
  for (const RunSignals& run : signals_of(dataset))
    for (Side side : kSides)
      for (Eigen::Index j = 0; j < run.size(); ++j) {
        if (!run.conducting[side][static_cast<std::size_t>(j)]) continue;
        columns.emplace_back(run.motor_current_A[side][j], run.wheel_speed_rad_s[side][j],
                             run.current_direction[side][j]);
        voltage_V.push_back(run.motor_voltage_V[side][j]);
      }
  const Eigen::Map<const Eigen::Matrix3Xd> known(columns.front().data(), 3, std::ssize(columns));
  const Eigen::Map<const Eigen::VectorXd> read(voltage_V.data(), std::ssize(voltage_V));
  const Eigen::Vector3d found = known.transpose().colPivHouseholderQr().solve(read);
  EXPECT_NEAR(found[0], 2.74, 0.02 * 2.74);
  EXPECT_NEAR(found[2], 0.3, 0.01);
}

/// Of a small current within the noise of its samples, the mean tells the sign; noise at rest has none.
TEST(CurrentDirection, OfSamplesWithinTheirNoiseIsThatOfTheirMean) {
  joulepath::Run run = testing::synthetic_run(testing::nomad(), "slow", 20, 0, testing::constant_speed(0.1),
                                              {0.001, 0.3, 0.01});
  const RunSignals moving = make_run_signals(run, 0, testing::nomad());
  EXPECT_GT(moving.current_direction.left.mean(), 0.95);
  run = testing::synthetic_run(testing::nomad(), "rest", 20, 0, testing::constant_speed(0), {0.001, 0.03, 0});
  const RunSignals resting = make_run_signals(run, 0, testing::nomad());
  EXPECT_LT(std::abs(resting.current_direction.left.mean()), 0.15);
  EXPECT_LT(resting.current_direction.left.cwiseAbs().mean(), 0.35);
  EXPECT_EQ(
      make_run_signals(
          {.name = "none", .log = {.time_s = run.log.time_s, .wheel_speed_rad_s = run.log.wheel_speed_rad_s}},
          0, testing::nomad())
          .current_direction.left.size(),
      0);
}

TEST(DriverDrop, IsFoundWithItsSizeWhereCurrentsChangeTheirSign) {
  for (const double drop_V : {0.3, 0.6}) {
    const Diagnosis d = diagnose(with_drop(drop_V), {.bootstrap = 50});
    ASSERT_EQ(d.causes.size(), 1u) << drop_V << ' ' << verdict_name(d.verdict);
    EXPECT_EQ(d.causes[0].effect.name, "driver_voltage_drop");
    EXPECT_NEAR(d.causes[0].parameters[0].value, drop_V, 0.05 * drop_V);
    EXPECT_EQ(d.verdict, Verdict::explained) << drop_V;
  }
}

/// A drop of 0.35 V over a winding of 0.05 ohm looks like a greater resistance, and like a shift of the
/// readings.
TEST(DriverDrop, IsNeitherAForeignWindingNorADelay) {
  const Dataset dataset = with_drop(0.35, 0.02);
  EXPECT_TRUE(foreign_constants(dataset.robot, signals_of(dataset)).empty());
  std::vector<std::size_t> all(dataset.runs.size());
  for (std::size_t r = 0; r < all.size(); ++r) all[r] = r;
  EXPECT_EQ(rough_channel_delay_s({.dataset = &dataset, .runs = all}), 0.0);
}

}  // namespace
}  // namespace joulepath
