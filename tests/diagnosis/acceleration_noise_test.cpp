// Noise of the encoders in the accelerations: it must not count as motion, nor contradict runs that
// accelerate.
#include "diagnosis/signals/acceleration_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/evidence/identify.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/signals/manoeuvres.hpp"
#include "diagnosis/signals/runs_by_use.hpp"
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

/// White noise of 0.2 on both wheels, and the gain of its means over a window of 11 samples.
constexpr double kWhiteNoise = 0.2, kPeriodOfNoise_s = 0.1, kMeanGain = 1.0 / 11;

Sided<Eigen::VectorXd> with_noise(const Eigen::VectorXd& acceleration, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Sided<Eigen::VectorXd> noisy{acceleration, acceleration};
  for (Side side : kSides)
    for (double& value : noisy[side]) value += kWhiteNoise * normal(random);
  return noisy;
}

TEST(AccelerationNoise, WhatStandsOutOfWhiteNoiseStays) {
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(400);
  acceleration.tail(200).setOnes();
  const Sided<Eigen::VectorXd> given = with_noise(acceleration, 4);
  Sided<Eigen::VectorXd> found = given, sparse = given;
  remove_acceleration_noise(found, 20, kPeriodOfNoise_s, kMeanGain);
  EXPECT_GT(share_without(found.left.head(190)), 0.97);
  const Eigen::VectorXd left = (found.left + found.right).tail(190),
                        all = (given.left + given.right).tail(190);
  EXPECT_LT((left - all).cwiseQuotient(all).cwiseAbs().maxCoeff(), 1e-12);
  remove_acceleration_noise(sparse, 20, 0.3, kMeanGain);
  EXPECT_EQ(sparse.left, given.left);
}

/// A controller that settles: the speed falls slowly for seconds, by less than a sample shows. Differences of
/// white noise, as those of speeds are, have means over a window that hold next to none.
TEST(AccelerationNoise, ASlowFallOfTheSpeedIsFound) {
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(1200);
  acceleration.segment(300, 600).setConstant(-0.1);
  Sided<Eigen::VectorXd> found = with_noise(Eigen::VectorXd::Zero(1201), 6);
  for (Side side : kSides)
    found[side] = acceleration + (found[side].tail(1200) - found[side].head(1200)) / std::sqrt(2.0);
  remove_acceleration_noise(found, 35, kPeriodOfNoise_s, kMeanGain / 11);
  const Eigen::VectorXd mean = 0.5 * (found.left + found.right);
  EXPECT_NEAR(mean.segment(310, 580).mean(), -0.1, 0.01);
  EXPECT_GT(share_without(mean.head(290)), 0.97);
}

/// The same through the kernel, whose means have a noise far smaller than a sample's.
TEST(AccelerationNoise, ASlowFallOfALoggedSpeedIsFound) {
  const double radius_m = testing::nomad().geometry.wheel_radius_m.left, due_rad_s2 = -0.12;
  double sum = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const RunSignals found = signals_of(
        [&](double t) {
          return BodyMotion<double>{.speed_m_s = 0.6 + due_rad_s2 * radius_m * t,
                                    .acceleration_m_s2 = due_rad_s2 * radius_m};
        },
        seed);
    const Sided<Eigen::VectorXd>& wheels = found.wheel_acceleration_rad_s2;
    sum += 0.5 * (wheels.left.mean() + wheels.right.mean());
  }
  EXPECT_NEAR(sum / 5, due_rad_s2, 0.2 * std::abs(due_rad_s2));
}

/// A robot at rest logs zeros. With noise once it moves, and without, it has no acceleration before it
/// starts.
TEST(AccelerationNoise, ARestBeforeAStartHasNone) {
  const Robot robot = testing::nomad();
  for (const double noise_rad_s : {0.0, 0.02}) {
    auto run = testing::synthetic_run(
        robot, "run", 12, 0,
        [](double t) {
          return t < 5 ? BodyMotion<double>{}
                       : BodyMotion<double>{.speed_m_s = 0.08 * (t - 5), .acceleration_m_s2 = 0.08};
        },
        {.speed_rad_s = noise_rad_s}, 3);
    for (Side side : kSides)
      for (std::size_t k = 0; run.log.time_s[k] < 5; ++k) run.log.wheel_speed_rad_s[side][k] = 0;
    const RunSignals found = make_run_signals(run, 0, robot);
    for (Eigen::Index j = 0; found.time_s[j] < 5 - 4 * kKernelSigma_s; ++j)
      EXPECT_EQ(found.wheel_acceleration_rad_s2.left[j], 0) << noise_rad_s << " " << found.time_s[j];
  }
}

/// Of white noise of the speeds, under the kernel, next to nothing is left.
TEST(AccelerationNoise, OfSpeedsUnderTheKernelIsNone) {
  double left = 0, all = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const RunSignals steady = signals_of(testing::constant_speed(0.6), seed);
    const Eigen::VectorXd mean =
        steady.wheel_acceleration_rad_s2.left + steady.wheel_acceleration_rad_s2.right;
    left += static_cast<double>((mean.array() != 0).count()), all += static_cast<double>(mean.size());
  }
  EXPECT_LT(left / all, 0.03) << "0.1 % of windows and 1 % of means, which overlap";
}

/// Makes the speeds differences of an encoder's counts.
void count_wheels(double counts, joulepath::Run& run) {
  for (Side side : kSides) {
    double angle_rad = 0, last_rad = 0;
    for (double& speed : run.log.wheel_speed_rad_s[side]) {
      angle_rad += 0.02 * speed;
      const double whole_rad = std::floor(angle_rad * counts / 6.283185307) * 6.283185307 / counts;
      speed = (whole_rad - last_rad) / 0.02, last_rad = whole_rad;
    }
  }
}

/// Speeds from an encoder's counts: their noise has little of its power where accelerations are. A gentle
/// ramp of 0.05 m/s^2 at 2000 counts a turn stays, steady driving at 360 counts has no acceleration.
TEST(AccelerationNoise, CountsOfAnEncoderHideNoGentleRamp) {
  const Robot robot = testing::nomad();
  const auto counted = [&](double counts, double acceleration_m_s2) {
    auto run = testing::synthetic_run(robot, "run", 20, 0, [=](double t) {
      return BodyMotion<double>{.speed_m_s = 0.2 + acceleration_m_s2 * t,
                                .acceleration_m_s2 = acceleration_m_s2};
    });
    count_wheels(counts, run);
    return make_run_signals(run, 0, robot).wheel_acceleration_rad_s2;
  };
  const double due = 0.05 / robot.geometry.wheel_radius_m.left;
  EXPECT_NEAR(counted(2000, 0.05).left.segment(5, 180).mean(), due, 0.2 * due);
  EXPECT_GT(share_without(counted(360, 0.0).left), 0.9);
}

/// Four runs that weave, as an encoder counts them.
Dataset weaving_day(double counts) {
  Dataset day{.robot = testing::nomad()};
  for (int k = 0; k < 4; ++k) {
    day.runs.push_back(testing::synthetic_run(day.robot, "weave", 20, 0,
                                              testing::swinging(0.5, 0.2, 1 + 0.1 * k, 0.3, 1.1)));
    count_wheels(counts, day.runs.back());
  }
  return day;
}

/// Noise of an acceleration is motion without torque: a fit finds the share of the inertia that the true
/// accelerations have in the measured ones. The kernel is as wide as leaves all but a percent of it, and rows
/// keep their distance in its widths; fine encoders keep the usual kernel exactly.
TEST(AccelerationNoise, OfCoarseEncodersTakesNoInertia) {
  const Dataset day = weaving_day(512);
  const RunsByUse coarse = sort_runs(day), fine = sort_runs(weaving_day(40000));
  double due_by_found = 0, found_square = 0;
  for (const RunSignals& run : coarse.signals)
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const BodyMotion<double> due =
          testing::swinging(0.5, 0.2, 1 + 0.1 * static_cast<double>(run.run_index), 0.3, 1.1)(run.time_s[j]);
      const double found = run.rolled_motion(day.robot.geometry, j).yaw_acceleration_rad_s2;
      due_by_found += due.yaw_acceleration_rad_s2 * found, found_square += found * found;
    }
  EXPECT_GT(due_by_found / found_square, 0.99);
  EXPECT_NEAR(coarse.options.period_s / coarse.options.kernel_sigma_s, kPeriod_s / kKernelSigma_s, 1e-9);
  EXPECT_EQ(fine.options.kernel_sigma_s, kKernelSigma_s);
  EXPECT_EQ(fine.options.period_s, kPeriod_s);
}

/// A wide arc is a turn: 2 m at 0.25 m/s. The noise of a straight run's wheels is none.
TEST(AccelerationNoise, AWideArcHasYaw) {
  const Geometry geometry = testing::nomad().geometry;
  EXPECT_FALSE(has_yaw({signals_of(testing::constant_speed(0.6))}, geometry));
  const auto arc = [](double) { return BodyMotion<double>{.speed_m_s = 0.25, .yaw_rate_rad_s = 0.125}; };
  EXPECT_TRUE(has_yaw({signals_of(testing::constant_speed(0.6)), signals_of(arc)}, geometry));
}

TEST(AccelerationNoise, SteadyMotionHasNoAcceleration) {
  const RunSignals steady = signals_of(testing::constant_speed(0.6));
  for (Side side : kSides) EXPECT_GT(share_without(steady.wheel_acceleration_rad_s2[side]), 0.97);
}

/// A long dataset is thinned after its noise is judged.
TEST(AccelerationNoise, ALongDatasetsSteadyMotionHasNoneEither) {
  const Robot robot = testing::nomad();
  const joulepath::Run run =
      testing::synthetic_run(robot, "run", 60, 0, testing::constant_speed(0.6), kEncoderNoise, 1);
  const RunSignals often = make_run_signals(run, 0, robot),
                   rarely = make_run_signals(run, 0, robot, {.period_s = kCoarsestPeriod_s});
  EXPECT_NEAR(rarely.period_s, kCoarsestPeriod_s, 1e-9);
  ASSERT_EQ(rarely.size(), (often.size() + 3) / 4);
  for (Side side : kSides) EXPECT_GT(share_without(rarely.wheel_acceleration_rad_s2[side]), 0.97);
  for (Eigen::Index j = 0; j < rarely.size(); ++j)
    EXPECT_EQ(rarely.wheel_acceleration_rad_s2.left[j], often.wheel_acceleration_rad_s2.left[4 * j]);
}

/// A run that turns for a while: where it does not, the wheels' difference is noise and has no yaw rate.
TEST(AccelerationNoise, AStraightPartOfARunThatTurnsHasNoYawRate) {
  const Geometry geometry = testing::nomad().geometry;
  const RunSignals found = signals_of(
      [](double t) { return BodyMotion<double>{.speed_m_s = 0.5, .yaw_rate_rad_s = t > 12 ? 0.6 : 0.0}; });
  const RunSignals moves = straightened_where_straight(found);
  double share = 0, straight = 0;
  for (Eigen::Index j = 0; j < found.size(); ++j) {
    if (found.time_s[j] > 13) {
      EXPECT_EQ(moves.rolled_motion(geometry, j).yaw_rate_rad_s,
                found.rolled_motion(geometry, j).yaw_rate_rad_s);
    } else if (found.time_s[j] < 11) {
      straight += 1, share += std::abs(moves.rolled_motion(geometry, j).yaw_rate_rad_s) < 1e-12;
    }
    EXPECT_NEAR(moves.rolled_motion(geometry, j).speed_m_s, found.rolled_motion(geometry, j).speed_m_s,
                1e-12);
  }
  EXPECT_GT(share / straight, 0.97);
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
