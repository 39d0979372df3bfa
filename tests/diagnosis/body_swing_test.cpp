// Tires and gears are springs: the body swings behind its rotors, whose speeds the encoders read.
#include "diagnosis/prediction/body_swing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/prediction/rows.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// Natural frequencies (rad/s) along the way and in yaw, and their damping ratio.
constexpr double kAlong_rad_s = 25, kYaw_rad_s = 32, kDamping = 0.3;

/// Every 6 s up by `speed_m_s` and down again, within `ramp_s` and smooth in its jerk, and weaving.
testing::MotionLaw driven(double speed_m_s, double ramp_s, double weave_rad_s, double rate_rad_s) {
  constexpr double kRound = 2 * std::numbers::pi, kPeriod_s = 6;
  return [=](double t) {
    const double since_s = t - kPeriod_s * std::floor(t / kPeriod_s), left_s = kPeriod_s - since_s;
    const double way = since_s < left_s ? 1 : -1;
    const double share = std::clamp(std::min(since_s, left_s) / ramp_s, 0.0, 1.0);
    return BodyMotion<double>{.speed_m_s = 0.2 + speed_m_s * (share - std::sin(kRound * share) / kRound),
                              .acceleration_m_s2 = way * speed_m_s * (1 - std::cos(kRound * share)) / ramp_s,
                              .yaw_rate_rad_s = weave_rad_s * std::sin(rate_rad_s * t),
                              .yaw_acceleration_rad_s2 = weave_rad_s * rate_rad_s * std::cos(rate_rad_s * t)};
  };
}

/// A speed that follows another one as a mass on a spring and a damper.
class Sprung {
 public:
  explicit Sprung(double frequency_rad_s) : frequency_rad_s_(frequency_rad_s) {}
  void follow(double speed, double acceleration, double step_s) {
    acceleration_ += step_s * (2 * kDamping * frequency_rad_s_ * (acceleration - acceleration_) +
                               frequency_rad_s_ * frequency_rad_s_ * (speed - speed_));
    speed_ += step_s * acceleration_;
  }
  void stand_at(double speed) { speed_ = speed; }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] double acceleration() const { return acceleration_; }

 private:
  double frequency_rad_s_, speed_{}, acceleration_{};
};

/// Motions of the body, every millisecond, whose rotors move by a law.
std::vector<BodyMotion<double>> body_behind(const testing::MotionLaw& rotors, double duration_s,
                                            double step_s) {
  Sprung along(kAlong_rad_s), yaw(kYaw_rad_s);
  along.stand_at(rotors(0).speed_m_s);
  std::vector<BodyMotion<double>> motions;
  for (double t = 0; t < duration_s; t += step_s) {
    const BodyMotion<double> now = rotors(t);
    along.follow(now.speed_m_s, now.acceleration_m_s2, step_s);
    yaw.follow(now.yaw_rate_rad_s, now.yaw_acceleration_rad_s2, step_s);
    motions.push_back({along.speed(), along.acceleration(), yaw.speed(), yaw.acceleration()});
  }
  return motions;
}

/// A run whose encoders read the rotors; all other channels are the body's.
joulepath::Run swinging_run(double payload_kg, const testing::MotionLaw& rotors) {
  constexpr double kDuration_s = 18, kStep_s = 1e-3;
  const Robot robot = testing::nomad();
  const std::vector<BodyMotion<double>> motions = body_behind(rotors, kDuration_s + 0.1, kStep_s);
  const testing::MotionLaw body = [&](double t) {
    return motions[static_cast<std::size_t>(std::lround(t / kStep_s))];
  };
  joulepath::Run run = testing::synthetic_run(robot, "run", kDuration_s, payload_kg, body);
  double heading_rad = 0, x_m = 0, y_m = 0, t = 0;
  for (std::size_t k = 0; k < run.log.size(); ++k) {
    const BodyMotion<double> of_body = body(run.log.time_s[k]), of_rotors = rotors(run.log.time_s[k]);
    const Sided<double> ahead_rad_s =
        wheel_speeds_rad_s(robot.geometry, of_rotors.speed_m_s - of_body.speed_m_s,
                           of_rotors.yaw_rate_rad_s - of_body.yaw_rate_rad_s);
    for (Side side : kSides) {
      run.log.wheel_speed_rad_s[side][k] += ahead_rad_s[side];
      run.log.motor_voltage_V[side][k] += robot.motor[side].volts_per_speed_V_s_rad() * ahead_rad_s[side];
    }
    for (; t < run.log.time_s[k] + 0.01 - 0.5 * kStep_s; t += kStep_s) {  // to the end of the sample
      const BodyMotion<double> now = body(t);
      heading_rad += kStep_s * now.yaw_rate_rad_s;
      x_m += kStep_s * now.speed_m_s * std::cos(heading_rad);
      y_m += kStep_s * now.speed_m_s * std::sin(heading_rad);
    }
    run.log.gyro_yaw_rate_rad_s.push_back(of_body.yaw_rate_rad_s);
    run.log.heading_rad.push_back(heading_rad);
    run.log.position_x_m.push_back(x_m);
    run.log.position_y_m.push_back(y_m);
  }
  return run;
}

/// The lag that the rotors' own motion tells leaves less than half of what a rigid body leaves, although
/// speeds start and stop within a second and a half.
TEST(BodySwing, IsTheSecondDerivativeOfTheRotorsMotion) {
  const Robot robot = testing::nomad();
  const joulepath::Run run = swinging_run(4, driven(0.6, 1.6, 0.5, 2));
  const RunSignals signals = make_run_signals(run, 0, robot);
  BodyLag lag = swing_along(signals, robot.geometry), turn = swing_in_yaw(signals, robot.geometry);
  lag *= 1 / (kAlong_rad_s * kAlong_rad_s), turn *= 1 / (kYaw_rad_s * kYaw_rad_s);
  lag += turn;
  const auto worst = [&](const ModelPoint& point) {
    const ResidualRows rows = residual_rows(signals, point, predict(signals, point));
    return rows.value.middleRows(10, signals.size() - 20).cwiseAbs().colwise().maxCoeff().eval();
  };
  const auto rigid = worst({.robot = robot}), swung = worst({.robot = robot, .swing = lag});
  for (Channel channel : {kCurrentLeft, kCurrentRight, kGyro, kHeading, kPositionX, kPositionY})
    EXPECT_LT(swung[channel], 0.5 * rigid[channel]) << channel;
}

/// A copy of the rows' own noise is no swing.
TEST(BodySwing, OfNoisyEncodersIsNone) {
  const Robot robot = testing::nomad();
  const auto norm_of = [&](double noise_rad_s) {
    const joulepath::Run run = testing::synthetic_run(
        robot, "run", 15, 4, testing::swinging(0.5, 0.2, 0.8, 1.2, 1.5), {.speed_rad_s = noise_rad_s}, 1);
    const RunSignals signals = make_run_signals(run, 0, robot);
    return swing_along(signals, robot.geometry).along.rate.norm() +
           swing_in_yaw(signals, robot.geometry).turn.rate.norm();
  };
  EXPECT_EQ(norm_of(0.1), 0);
  EXPECT_GT(norm_of(0.001), 0);
}

}  // namespace
}  // namespace joulepath
