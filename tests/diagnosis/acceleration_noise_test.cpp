// Noise of the encoders in the accelerations: it must not count as motion, nor contradict runs that
// accelerate.
#include "diagnosis/signals/acceleration_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr testing::LogNoise kEncoderNoise{.speed_rad_s = 0.1, .current_A = 0.005, .voltage_V = 0.02};

RunSignals signals_of(const testing::MotionLaw& law, unsigned seed = 1) {
  const Robot robot = testing::nomad();
  return make_run_signals(testing::synthetic_run(robot, "run", 20, 0, law, kEncoderNoise, seed), 0, robot);
}

double share_without(const Eigen::VectorXd& acceleration) {
  return static_cast<double>((acceleration.array().abs() < 1e-9).count()) /
         static_cast<double>(acceleration.size());
}

TEST(AccelerationNoise, ItsVarianceIsThatOfWhiteNoiseOnASmoothSignal) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> samples, steps(500, 1.0);
  for (int k = 0; k < 5000; ++k) samples.push_back(3 * std::sin(0.02 * k) + 0.2 * normal(random));
  EXPECT_NEAR(white_noise_variance(samples), 0.04, 0.004);
  EXPECT_EQ(white_noise_variance(steps), 0.0);
  EXPECT_EQ(white_noise_variance({1, 2, 3}), 0.0);
}

TEST(AccelerationNoise, SteadyMotionHasNoAcceleration) {
  const RunSignals steady = signals_of(testing::constant_speed(0.6));
  for (Side side : kSides) EXPECT_GT(share_without(steady.wheel_acceleration_rad_s2[side]), 0.97);
}

/// The robot speeds up and slows down straight ahead: the wheels' mean accelerates, their difference does
/// not.
TEST(AccelerationNoise, DrivingAndTurningAreJudgedEachByItself) {
  const RunSignals straight = signals_of(testing::swinging(0.6, 0.3, 1.0));
  const Sided<Eigen::VectorXd>& found = straight.wheel_acceleration_rad_s2;
  EXPECT_GT(share_without(found.right - found.left), 0.97);
  const double radius_m = testing::nomad().geometry.wheel_radius_m.left;
  double error = 0, size = 0;
  for (Eigen::Index j = 0; j < straight.size(); ++j) {
    const double due = 0.3 * std::cos(straight.time_s[j]) / radius_m;
    error += std::pow(0.5 * (found.left[j] + found.right[j]) - due, 2), size += due * due;
  }
  EXPECT_LT(std::sqrt(error / size), 0.2);
}

/// Straight runs and weaving ones of a robot without any effect. Taken for motion, the noise of the straight
/// runs says that the robot has next to no yaw inertia, and their scatter against the others is 1.9.
TEST(AccelerationNoise, StraightRunsDoNotContradictWeavingOnes) {
  Dataset dataset{.robot = testing::nomad()};
  for (unsigned k = 0; k < 12; ++k) {
    const double weave_rad_s = k % 2 == 0 ? 0.0 : 1.2, mean_m_s = 0.3 + 0.1 * (k % 4);
    auto run =
        testing::synthetic_run(dataset.robot, "run " + std::to_string(k), 15, k % 3 * 4.0,
                               testing::swinging(mean_m_s, 0.2, 0.8, weave_rad_s, 1.5), kEncoderNoise, k + 1);
    run.start_time_s = 30.0 * k;
    dataset.runs.push_back(run);
  }
  const Identification id = identify({.dataset = &dataset, .runs = every(dataset.runs.size())});
  EXPECT_LT(id.dispersion, 1.3);
  EXPECT_TRUE(id.explanations.front().candidates.empty());
}

}  // namespace
}  // namespace joulepath
