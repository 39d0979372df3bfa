// Jerk as a constraint of the nonlinear program: closed forms, limits between nodes, every mode of time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath {
namespace {

ProfileRequest straight(double length_m, double jerk_m_s3) {
  const Robot robot = testing::nomad();
  ProfileRequest request{.piece = straight_piece({}, length_m),
                         .plant = make_plant(robot),
                         .limits = *robot.limits,
                         .nodes = 100};
  request.limits.jerk_m_s3 = jerk_m_s3;
  return request;
}

ProfileRequest bezier(double jerk_m_s3) {
  ProfileRequest request = straight(1, jerk_m_s3);
  request.piece = Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})});
  return request;
}

/// Seven segments of constant jerk from rest to rest; fewer where speed or acceleration is not reached.
double s_curve_duration_s(double length_m, double speed, double acceleration, double jerk) {
  const auto ramp_s = [&](double v) {
    return v >= acceleration * acceleration / jerk ? v / acceleration + acceleration / jerk
                                                   : 2 * std::sqrt(v / jerk);
  };
  const auto ramps_m = [&](double v) { return v * ramp_s(v); };
  if (ramps_m(speed) <= length_m) return 2 * ramp_s(speed) + (length_m - ramps_m(speed)) / speed;
  double low = 0, high = speed;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (ramps_m(middle) < length_m ? low : high) = middle;
  }
  return 2 * ramp_s(low);
}

Profile solved(const ProfileRequest& request) {
  const ProfileResult result = solve_profile(request);
  EXPECT_TRUE(result.profile.has_value()) << result.summary.message;
  if (!result.profile) return {};
  const ReplayResult again = replay(request, *result.profile);
  EXPECT_TRUE(again.valid()) << again.limit << " " << again.worst_violation << " at " << again.s;
  EXPECT_NEAR(again.end_s, piece_length(request.piece), 1e-6);
  EXPECT_NEAR(result.profile->rate.back(), request.end_rate, 1e-9);
  return *result.profile;
}

/// Samples 64 places of every segment, independently of the planner's own checks: the change of acceleration
/// over time, speed, and lateral and yaw acceleration by the path's curvature.
void expect_kept_between_nodes(const ProfileRequest& request, const Profile& profile) {
  constexpr int kPlaces = 64;
  constexpr double kSame = 1e-6, kStep_m = 1e-5;
  const Limits& limits = request.limits;
  const double length_m = piece_length(request.piece);
  const auto curvature = [&](double s) {
    return piece_point(request.piece, std::clamp(s, 0.0, length_m)).curvature_per_m;
  };
  double before = 0;
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k)
    for (int i = 0; i < kPlaces; ++i) {
      const double dt = (profile.time_s[k + 1] - profile.time_s[k]) / kPlaces, t = (i + 0.5) * dt;
      const double a = profile.acceleration[k] + profile.jerk[k] * (i + 1) * dt;
      EXPECT_LE(std::abs(a - before), limits.jerk_m_s3 * dt * (1 + kSame) + 1e-9) << profile.s[k];
      before = a;
      const double u = profile.rate[k] + t * (profile.acceleration[k] + 0.5 * t * profile.jerk[k]);
      const double here = profile.acceleration[k] + profile.jerk[k] * t;
      const double s =
          profile.s[k] + t * (profile.rate[k] + t * (profile.acceleration[k] / 2 + t * profile.jerk[k] / 6));
      EXPECT_LE(u, limits.speed_m_s * (1 + kSame));
      EXPECT_LE(here, limits.acceleration_m_s2 * (1 + kSame));
      EXPECT_GE(here, -limits.deceleration_m_s2 * (1 + kSame));
      EXPECT_LE(u * u * std::abs(curvature(s)), limits.lateral_acceleration_m_s2 * (1 + kSame));
      const double slope = (curvature(s + kStep_m) - curvature(s - kStep_m)) / (2 * kStep_m);
      const bool kink = std::abs(curvature(s + kStep_m) - 2 * curvature(s) + curvature(s - kStep_m)) > 1e-7;
      if (!kink) {
        EXPECT_LE(std::abs(curvature(s) * here + slope * u * u), limits.yaw_acceleration_rad_s2 * (1 + 1e-4))
            << s;
      }
    }
}

double energy_J(const ProfileRequest& request) { return replay(request, solved(request)).energy_J; }

TEST(Jerk, LeastTimeOfAStraightLineIsTheSevenSegmentSCurve) {
  for (double length_m : {0.5, 3.0, 10.0})
    for (double jerk_m_s3 : {0.2, 0.8, 3.0}) {
      ProfileRequest request = straight(length_m, jerk_m_s3);
      request.time = {.mode = TimeMode::minimum_time};
      const double exact_s =
          s_curve_duration_s(length_m, request.limits.speed_m_s, request.limits.acceleration_m_s2, jerk_m_s3);
      const double duration_s = solved(request).duration_s();
      EXPECT_GE(duration_s, exact_s * (1 - 1e-6)) << length_m << " m, " << jerk_m_s3 << " m/s^3";
      EXPECT_LE(duration_s, exact_s * (1 + 5e-5)) << length_m << " m, " << jerk_m_s3 << " m/s^3";
    }
}

TEST(Jerk, EveryTimeModeKeepsItsPromise) {
  ProfileRequest request = bezier(0.8);
  request.time = {.mode = TimeMode::minimum_time};
  const double least_s = solved(request).duration_s();
  request.time = {.mode = TimeMode::free_time};
  const double free_s = solved(request).duration_s();
  EXPECT_GT(free_s, least_s);
  const double between_s = 0.5 * (least_s + free_s);
  request.time = {.mode = TimeMode::fixed_time, .duration_s = 1.3 * free_s};
  EXPECT_NEAR(solved(request).duration_s(), 1.3 * free_s, 1e-6);
  request.time = {.mode = TimeMode::time_budget, .duration_s = between_s};
  EXPECT_NEAR(solved(request).duration_s(), between_s, 1e-6);
  request.time = {.mode = TimeMode::time_budget, .duration_s = 1.3 * free_s};
  EXPECT_NEAR(solved(request).duration_s(), free_s, 1e-3 * free_s);
  request.time = {.mode = TimeMode::time_price, .price_W = 20};
  const double priced_s = solved(request).duration_s();
  EXPECT_LT(priced_s, free_s);
  EXPECT_GE(priced_s, least_s * (1 - 1e-5));
}

TEST(Jerk, PriceOfASecondIsTheSlopeOfTheEnergy) {
  ProfileRequest request = straight(5, 0.5);
  request.plant.robot.power.standby_W = 0;
  const auto at = [&](double duration_s) {
    request.time = {.mode = TimeMode::time_budget, .duration_s = duration_s};
    return solve_profile(request);
  };
  const double T = 9, h = 0.05;
  const auto value = [&](const ProfileResult& result) { return replay(request, *result.profile).energy_J; };
  const double slope = (value(at(T - h)) - value(at(T + h))) / (2 * h);
  EXPECT_NEAR(at(T).summary.price_of_time_W, slope, 0.01 * slope);
}

TEST(Jerk, CostsEnergyAndLessOfItAsTheLimitGrows) {
  ProfileRequest request = bezier(kNoLimit);
  request.time = {.mode = TimeMode::time_budget, .duration_s = 12};
  const double without_J = energy_J(request);
  double before_J = kNoLimit;
  for (double jerk_m_s3 : {0.3, 1.0, 5.0, 1e4}) {
    request.limits.jerk_m_s3 = jerk_m_s3;
    const double with_J = energy_J(request);
    EXPECT_GE(with_J, without_J * (1 - 1e-5)) << jerk_m_s3;
    EXPECT_LE(with_J, before_J * (1 + 1e-5)) << jerk_m_s3;
    before_J = with_J;
  }
  EXPECT_NEAR(before_J, without_J, 2e-4 * without_J);
}

TEST(Jerk, StartsAndEndsAtSpeed) {
  for (TimeMode mode : {TimeMode::minimum_time, TimeMode::free_time}) {
    ProfileRequest request = bezier(0.6);
    request.start_rate = 0.5;
    request.end_rate = 0.3;
    request.time = {.mode = mode};
    const Profile profile = solved(request);
    EXPECT_EQ(profile.rate.front(), 0.5);
    EXPECT_NEAR(profile.acceleration.front(), 0, 1e-9);
  }
}

/// At constant speed from start to end there is nothing to optimize, and the jerk limit costs nothing.
TEST(Jerk, CruiseAtTheLimitIsTheFastestWhateverTheJerk) {
  ProfileRequest request = straight(4, 0.1);
  request.start_rate = request.end_rate = request.limits.speed_m_s;
  request.time = {.mode = TimeMode::minimum_time};
  EXPECT_NEAR(solved(request).duration_s(), 4 / request.limits.speed_m_s, 1e-5);
}

TEST(Jerk, TheBoundIsThatWithoutTheLimit) {
  ProfileRequest request = bezier(0.8);
  request.time = {.mode = TimeMode::time_budget, .duration_s = 14};
  const ProfileResult result = solve_profile(request);
  EXPECT_EQ(result.summary.status, SolveStatus::feasible);
  EXPECT_TRUE(result.summary.local);
  request.limits.jerk_m_s3 = kNoLimit;
  EXPECT_LE(result.summary.lower_bound_J, energy_J(request));
  EXPECT_GT(result.summary.lower_bound_J, 0);
}

/// Every kind of path, every mode of time, regeneration 0, 0.6 and 1, by wheel and by bus.
TEST(Jerk, FastSolverAndIpoptAgreeOnRandomProblems) {
  constexpr TimeMode kModes[] = {TimeMode::free_time, TimeMode::time_budget, TimeMode::fixed_time,
                                 TimeMode::time_price, TimeMode::minimum_time};
  testing::RandomProfiles random(20261123);
  for (int i = 0; i < 20; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    request.nodes = 60;
    request.limits.jerk_m_s3 = random.uniform(0.3, 2);
    request.time = {.mode = TimeMode::minimum_time};
    request.solver = SolverChoice::fast;
    const ProfileResult fastest = solve_profile(request);
    ASSERT_TRUE(fastest.profile) << i << ": " << fastest.summary.message;
    request.time = {kModes[i % 5], random.uniform(1.05, 2) * fastest.profile->duration_s(), 5.0};
    if (request.time.mode == TimeMode::time_price) request.time.duration_s = kNoLimit;
    const ProfileResult fast = solve_profile(request);
    EXPECT_TRUE(fast.summary.handed_over.empty()) << i << ": " << fast.summary.handed_over;
    const double fast_J = energy_J(request), fast_s = fast.profile->duration_s();
    expect_kept_between_nodes(request, *fast.profile);
    request.solver = SolverChoice::ipopt;
    const double settled_s = solve_profile(request).profile->duration_s();
    EXPECT_NEAR(fast_s, settled_s, 1e-3 * settled_s) << i;
    if (request.time.mode == TimeMode::minimum_time) continue;
    const double price_W = request.time.mode == TimeMode::time_price ? request.time.price_W : 0.0;
    EXPECT_NEAR(fast_J + price_W * (fast_s - settled_s), energy_J(request), 1e-5 * fast_J) << i;
  }
}

/// A deadline that an S-curve meets is met, however tight; one that it misses is refused.
TEST(Jerk, NoDeadlineThatAnSCurveMakesIsRefused) {
  ProfileRequest request = straight(3, 0.8);
  const double exact_s =
      s_curve_duration_s(3, request.limits.speed_m_s, request.limits.acceleration_m_s2, 0.8);
  for (double slack : {1e-4, 1e-3, 1e-2}) {
    request.time = {.mode = TimeMode::time_budget, .duration_s = exact_s * (1 + slack)};
    EXPECT_LE(solved(request).duration_s(), exact_s * (1 + slack) + 1e-6);
  }
  request.time.duration_s = 0.98 * exact_s;
  const ProfileResult result = solve_profile(request);
  EXPECT_EQ(result.summary.status, SolveStatus::infeasible);
  ASSERT_TRUE(result.infeasibility.has_value());
  EXPECT_EQ(result.infeasibility->constraint, "jerk");
  EXPECT_NEAR(result.infeasibility->relaxation.at("deadline_s"), exact_s, 1e-4 * exact_s);
}

/// A deadline far below the least time: a relaxation of the problem without the jerk limit is not offered.
TEST(Jerk, WhatIsOfferedForAnImpossibleDeadlineIsPlanned) {
  for (double share : {0.3, 0.95}) {
    ProfileRequest request = straight(3, 0.8);
    const double exact_s =
        s_curve_duration_s(3, request.limits.speed_m_s, request.limits.acceleration_m_s2, 0.8);
    request.time = {.mode = TimeMode::time_budget, .duration_s = share * exact_s};
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.infeasibility);
    for (const auto& [key, value] : result.infeasibility->relaxation) {
      ProfileRequest relaxed = request;
      (key == "jerk_m_s3" ? relaxed.limits.jerk_m_s3 : relaxed.time.duration_s) = value;
      EXPECT_TRUE(solve_profile(relaxed).profile) << share << ": " << key << " = " << value;
    }
  }
}

TEST(Jerk, LeavesATurnInPlaceAlone) {
  ProfileRequest request = straight(1, 0.5);
  request.piece = TurnInPlace{{}, 1.5};
  const double with_J = energy_J(request);
  request.limits.jerk_m_s3 = kNoLimit;
  EXPECT_EQ(with_J, energy_J(request));
}

/// For a limit of 0 the verdict names the smallest limit that works, however small.
TEST(Jerk, ALimitOfZeroIsAnsweredBelowAThousandth) {
  ProfileRequest request = straight(3, 0.0);
  request.nodes = 40;
  request.solver = SolverChoice::fast;
  constexpr double kEnough = 2e-4;
  request.time = {.mode = TimeMode::time_budget,
                  .duration_s = 1.001 * s_curve_duration_s(3, request.limits.speed_m_s,
                                                           request.limits.acceleration_m_s2, kEnough)};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.infeasibility);
  EXPECT_NEAR(result.infeasibility->relaxation.at("jerk_m_s3"), kEnough, 0.03 * kEnough);
}

/// Brakes of a third of the acceleration make the drive longer than the equal, strong ones would, and shorter
/// than two weak ones: no deadline between is refused.
TEST(Jerk, UnequalAccelerationAndBrakingArePlannedAndBounded) {
  ProfileRequest request = straight(4, 2);
  request.solver = SolverChoice::fast;
  request.limits.acceleration_m_s2 = 0.9;
  request.limits.deceleration_m_s2 = 0.3;
  const double strong_s = s_curve_duration_s(4, request.limits.speed_m_s, 0.9, 2),
               weak_s = s_curve_duration_s(4, request.limits.speed_m_s, 0.3, 2);
  request.time = {TimeMode::minimum_time};
  const ProfileResult fastest = solve_profile(request);
  ASSERT_TRUE(fastest.profile.has_value()) << fastest.summary.message;
  EXPECT_GT(fastest.profile->duration_s(), strong_s);
  EXPECT_LT(fastest.profile->duration_s(), 0.95 * weak_s);
  EXPECT_GE(fastest.summary.lower_bound_s, strong_s * (1 - 1e-6));
  request.time = {TimeMode::time_budget, 0.97 * weak_s};
  EXPECT_TRUE(solve_profile(request).profile.has_value());
}

}  // namespace
}  // namespace joulepath
