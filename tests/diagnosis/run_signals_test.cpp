#include "diagnosis/signals/run_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kHeading_rad = 0.6, kAcceleration_rad_s2 = 0.4;

/// The left wheel keeps 2 rad/s, the right one speeds up; the heading is measured (and does not fit to them).
Run straight_run() {
  Run run{.name = "straight"};
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * (i + 1);
    run.log.time_s.push_back(t);
    run.log.wheel_speed_rad_s.left.push_back(2.0);
    run.log.wheel_speed_rad_s.right.push_back(kAcceleration_rad_s2 * (t - 0.005));
    run.log.heading_rad.push_back(kHeading_rad);
    run.log.motor_voltage_V.left.push_back(12.0);
    run.log.motor_current_A.left.push_back(1.5);
    run.log.motor_current_A.right.push_back(0.5);
    run.log.battery_voltage_V.push_back(24.0);
    run.log.battery_current_A.push_back(2.0);
  }
  return run;
}

/// A Gaussian kernel leaves lines as they are.
TEST(RunSignals, LinesPassUnchanged) {
  const RunSignals signals = make_run_signals(straight_run(), 0, testing::nomad());
  ASSERT_GT(signals.size(), 10);
  const double rate_x = 2.0 * std::cos(kHeading_rad), rate_y = 2.0 * std::sin(kHeading_rad);
  for (Eigen::Index j = 2; j + 2 < signals.size(); ++j) {
    const double step_s = signals.time_s[j] - signals.time_s[j - 1];
    EXPECT_NEAR(signals.wheel_speed_rad_s.left[j], 2.0, 1e-9);
    EXPECT_NEAR(signals.wheel_acceleration_rad_s2.left[j], 0.0, 1e-9);
    EXPECT_NEAR(signals.wheel_acceleration_rad_s2.right[j], kAcceleration_rad_s2, 1e-6);
    EXPECT_NEAR(signals.wheel_angle_rad.left[j] - signals.wheel_angle_rad.left[j - 1], 2.0 * step_s, 1e-9);
    EXPECT_NEAR(signals.wheel_along_x_rad.left[j] - signals.wheel_along_x_rad.left[j - 1], rate_x * step_s,
                1e-9);
    EXPECT_NEAR(signals.wheel_along_y_rad.left[j] - signals.wheel_along_y_rad.left[j - 1], rate_y * step_s,
                1e-9);
    EXPECT_NEAR(signals.heading_rad[j], kHeading_rad, 1e-9);
  }
}

/// 33 samples a second, stamped in whole milliseconds: most steps are 30 ms, their mean is 30.3 ms.
TEST(RunSignals, TimeIsThatOfTheClockWhereStampsAreRounded) {
  joulepath::Run run{.name = "rounded"};
  for (int i = 0; i < 400; ++i) {
    const double t = (i + 1) / 33.0;
    run.log.time_s.push_back(std::round(1000 * t) / 1000);
    run.log.wheel_speed_rad_s.left.push_back(2.0);
    run.log.wheel_speed_rad_s.right.push_back(kAcceleration_rad_s2 * t);
  }
  const RunSignals signals = make_run_signals(run, 0, testing::nomad());
  const Eigen::Index last = signals.size() - 1;
  const double length_s = signals.time_s[last] - signals.time_s[0];
  EXPECT_NEAR(signals.wheel_angle_rad.left[last] - signals.wheel_angle_rad.left[0], 2.0 * length_s,
              1e-3 * 2.0 * length_s);
  EXPECT_NEAR(signals.period_s * static_cast<double>(last), length_s, 1e-3 * length_s);
  EXPECT_NEAR(signals.wheel_acceleration_rad_s2.right[last / 2], kAcceleration_rad_s2,
              1e-3 * kAcceleration_rad_s2);
}

/// V i where both are measured, (R i + Kv n q') i where the voltage is not.
TEST(RunSignals, PowerIsThatOfEachSample) {
  const Robot robot = testing::nomad();
  const RunSignals signals = make_run_signals(straight_run(), 0, robot);
  const Motor& motor = robot.motor.right;
  for (Eigen::Index j = 2; j + 2 < signals.size(); ++j) {
    const double back_emf_V = motor.volts_per_speed_V_s_rad() * signals.wheel_speed_rad_s.right[j];
    EXPECT_NEAR(signals.motor_power_W.left[j], 18.0, 1e-9);
    EXPECT_NEAR(signals.motor_power_W.right[j], (0.5 * motor.resistance_ohm + back_emf_V) * 0.5, 1e-9);
    EXPECT_NEAR(signals.battery_power_W[j], 48.0, 1e-9);
  }
}

}  // namespace
}  // namespace joulepath
