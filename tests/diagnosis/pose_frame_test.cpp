// Days of robots as their files say: speeds at the stamp, noisy wheels, a pose in whatever frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::MotionLaw;
using testing::swinging;

constexpr double kCoarse_s = 0.04, kStepOfPose_s = 1e-3;

struct Frame {
  double x_m{}, y_m{}, turned_rad{};
};

/// Adds the pose of a motion, in small steps, as a frame shows it, and a gyro.
void log_pose(const MotionLaw& law, const Frame& frame, unsigned seed, Trajectory& log) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double x_m = 0, y_m = 0, heading_rad = 0.4 * seed, time_s = 0;
  const double cosine = std::cos(frame.turned_rad), sine = std::sin(frame.turned_rad);
  for (const double at_s : log.time_s) {
    for (; time_s < at_s - 0.5 * kStepOfPose_s; time_s += kStepOfPose_s) {
      const BodyMotion<double> motion = law(time_s + 0.5 * kStepOfPose_s);
      const double middle_rad = heading_rad + 0.5 * kStepOfPose_s * motion.yaw_rate_rad_s;
      x_m += kStepOfPose_s * motion.speed_m_s * std::cos(middle_rad);
      y_m += kStepOfPose_s * motion.speed_m_s * std::sin(middle_rad);
      heading_rad += kStepOfPose_s * motion.yaw_rate_rad_s;
    }
    // The noise belongs to the robot, so that it turns with the frame.
    const double noisy_x_m = x_m + 0.004 * normal(random), noisy_y_m = y_m + 0.004 * normal(random);
    log.position_x_m.push_back(frame.x_m + cosine * noisy_x_m - sine * noisy_y_m);
    log.position_y_m.push_back(frame.y_m + sine * noisy_x_m + cosine * noisy_y_m);
    log.heading_rad.push_back(heading_rad + frame.turned_rad + 0.003 * normal(random));
    log.gyro_yaw_rate_rad_s.push_back(law(at_s).yaw_rate_rad_s + 0.003 * normal(random));
  }
}

Robot amr() { return read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/amr_150kg.yaml"); }

/// 12 runs of a robot that is as its file says.
Dataset day_of(const std::function<MotionLaw(unsigned)>& law_of, const Frame& frame, unsigned first_seed,
               const testing::LogNoise& noise, double period_s) {
  Dataset day{.robot = amr()};
  for (unsigned number = 0; number < 12; ++number) {
    const MotionLaw law = law_of(number);
    const unsigned seed = first_seed + number;
    joulepath::Run& run = day.runs.emplace_back(testing::synthetic_run(
        day.robot, "run_" + std::to_string(number), 28, 40.0 * (number % 3), law, noise, seed, period_s));
    log_pose(law, frame, seed, run.log);
  }
  return day;
}

Dataset day_in(const Frame& frame, unsigned first_seed = 1) {
  const auto law = [](unsigned number) {
    return swinging(0.35, 0.35, 0.8 + 0.1 * (number % 4), number % 3 == 0 ? 0.0 : 0.6,
                    0.5 + 0.1 * (number % 5));
  };
  return day_of(law, frame, first_seed, {0.02, 0.05, 0.05}, kCoarse_s);
}

struct Phase {
  double duration_s{}, acceleration_m_s2{}, yaw_acceleration_rad_s2{};
};

MotionLaw in_phases(std::vector<Phase> phases) {
  return [phases = std::move(phases)](double t) {
    BodyMotion<double> motion;
    for (const Phase& phase : phases) {
      const double spent_s = std::clamp(t, 0.0, phase.duration_s);
      motion.speed_m_s += spent_s * phase.acceleration_m_s2;
      motion.yaw_rate_rad_s += spent_s * phase.yaw_acceleration_rad_s2;
      const bool now = t >= 0 && t < phase.duration_s;
      motion.acceleration_m_s2 += now ? phase.acceleration_m_s2 : 0;
      motion.yaw_acceleration_rad_s2 += now ? phase.yaw_acceleration_rad_s2 : 0;
      t -= phase.duration_s;
    }
    return motion;
  };
}

/// Straight drives and turns on the spot, between stops. The controller settles: after each start the speed
/// falls slowly.
MotionLaw stop_and_go(unsigned number) {
  const double a = 0.4 + 0.05 * (number % 3), yaw = (number % 2 == 0 ? 1 : -1) * (1.0 + 0.1 * (number % 4));
  std::vector<Phase> phases;
  for (const double way : {1.0, -1.0, 1.0}) {
    phases.insert(phases.end(), {{1.0, 0, 0}, {2.0, a, 0}, {2.0, -0.02, 0}, {2 - 0.04 / a, -a, 0}});
    phases.insert(phases.end(), {{0.5, 0, 0}, {1.1, 0, way * yaw}, {1.0, 0, -0.03 * way * yaw}});
    phases.push_back({1.07, 0, -way * yaw});
  }
  return in_phases(phases);
}

/// Speeds at the stamp are half a sample later than the means that encoders count: no slip of the wheels.
TEST(PoseOfCoarseLogs, SpeedsAtTheirStampsAreNoSlip) {
  for (const unsigned seed : {1U, 50U}) {
    const Diagnosis d = diagnose(day_in({}, seed), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::no_gap) << seed;
    EXPECT_TRUE(d.causes.empty()) << seed;
    EXPECT_TRUE(d.below_materiality.empty()) << seed << " " << d.below_materiality.front().effect;
  }
}

/// A frame that is turned, or whose origin is far away, changes no answer.
TEST(PoseFrame, ChangesNoAnswer) {
  const Diagnosis here = diagnose(day_in({}), {.bootstrap = 20});
  for (const Frame& frame : {Frame{0, 0, 1.1}, Frame{3, -7, 2.5}, Frame{4e5, 5e6, -0.7}}) {
    const Diagnosis there = diagnose(day_in(frame), {.bootstrap = 20});
    EXPECT_EQ(there.verdict, here.verdict) << frame.turned_rad;
    EXPECT_EQ(there.below_materiality.size(), here.below_materiality.size()) << frame.turned_rad;
    EXPECT_NEAR(there.gap.position_m.before_rms, here.gap.position_m.before_rms,
                0.02 * here.gap.position_m.before_rms)
        << frame.turned_rad;
    EXPECT_NEAR(there.gap.position_m.noise_floor_rms, here.gap.position_m.noise_floor_rms,
                0.02 * here.gap.position_m.noise_floor_rms)
        << frame.turned_rad;
  }
}

/// Wheel speeds with noise of 0.6 % of their greatest, straight drives and turns on the spot: the noise of
/// the wheels is no slip, and no friction less than the file's.
TEST(NoisyWheels, AreNoEvidence) {
  for (const unsigned seed : {1U, 50U, 90U}) {
    const Diagnosis d = diagnose(day_of(stop_and_go, {}, seed, {0.06, 0.1, 0.05}, 0.02), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::no_gap) << seed;
    EXPECT_TRUE(d.causes.empty()) << seed << " " << d.causes.front().effect.name;
  }
}

}  // namespace
}  // namespace joulepath
