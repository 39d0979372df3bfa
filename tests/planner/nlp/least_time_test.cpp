// The least time: proven, reached, and never refused above it.
#include "planner/profile/least_time.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/motion/replay.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"
#include "tests/support/with_room.hpp"

namespace joulepath {
namespace {

ProfileRequest in_time(ProfileRequest request, TimeMode mode, double duration_s) {
  request.time = {.mode = mode, .duration_s = duration_s};
  request.solver = SolverChoice::fast;
  return request;
}

ProfileResult fastest(const ProfileRequest& request) {
  return solve_profile(in_time(request, TimeMode::minimum_time, kNoLimit));
}

/// Trapezoid or triangle: length / v + v / (2 a) + v / (2 d), or sqrt(2 length (1/a + 1/d)).
double closed_form_s(const ProfileRequest& request) {
  const double length_m = piece_length(request.piece), v = request.limits.speed_m_s;
  const double slope = 1 / request.limits.acceleration_m_s2 + 1 / request.limits.deceleration_m_s2;
  return length_m > v * v * slope / 2 ? length_m / v + v * slope / 2 : std::sqrt(2 * length_m * slope);
}

TEST(LeastTime, OfStraightLinesIsTheClosedForm) {
  testing::RandomProfiles random(3);
  for (int i = 0; i < 40; ++i) {
    ProfileRequest request = random.next(testing::PathClass::straight);
    request.limits.speed_m_s = random.uniform(0.2, 1);
    request.limits.acceleration_m_s2 = random.uniform(0.1, 0.5);
    request.limits.deceleration_m_s2 = random.uniform(0.1, 0.5);
    const double exact_s = closed_form_s(request);
    const ProfileResult result = fastest(request);
    ASSERT_TRUE(result.profile) << result.summary.message;
    EXPECT_LE(result.summary.lower_bound_s, exact_s);
    EXPECT_GE(result.summary.lower_bound_s, exact_s * (1 - 1e-6));
    EXPECT_LE(result.profile->duration_s(), exact_s * (1 + 1e-6));
    EXPECT_EQ(result.summary.status, SolveStatus::optimal);
    for (TimeMode mode : {TimeMode::time_budget, TimeMode::fixed_time})
      for (double slack : {1e-6, 1e-5, 1e-4}) {
        const ProfileRequest late = in_time(request, mode, exact_s * (1 + slack));
        const ProfileResult plan = solve_profile(late);
        ASSERT_TRUE(plan.profile) << slack << " " << plan.summary.message;
        EXPECT_LE(plan.profile->duration_s(), late.time.duration_s * (1 + 1e-7));
        EXPECT_TRUE(replay(late, *plan.profile).valid());
      }
    const ProfileResult refused =
        solve_profile(in_time(request, TimeMode::time_budget, exact_s * (1 - 1e-5)));
    EXPECT_EQ(refused.summary.status, SolveStatus::infeasible);
  }
}

TEST(LeastTime, OfCurvesIsBelowThatOfFineGridsAndComesClose) {
  testing::RandomProfiles random(12);
  for (int i = 0; i < 12; ++i) {
    const ProfileRequest request = random.next(testing::kPathClasses[1 + i % 3]);
    ProfileRequest fine = testing::with_room(request, 1e-6);
    fine.nodes = 1600;
    const ProfileResult result = fastest(request), other = fastest(fine);
    ASSERT_TRUE(result.profile && other.profile) << result.summary.message << other.summary.message;
    ASSERT_LE(replay(request, *other.profile).worst_violation, 1e-9);
    EXPECT_LE(result.summary.lower_bound_s, other.profile->duration_s()) << i;
    EXPECT_LE(result.profile->duration_s(), result.summary.lower_bound_s * (1 + 3e-5)) << i;
    const double asked_s = other.profile->duration_s() * (1 + 1e-6);
    const ProfileResult plan = solve_profile(in_time(request, TimeMode::time_budget, asked_s));
    ASSERT_TRUE(plan.profile) << i << " " << plan.summary.message;
    EXPECT_LE(plan.profile->duration_s(), asked_s * (1 + 1e-7)) << i;
  }
}

/// What a verdict offers can be planned, and nothing much below it can.
TEST(LeastTime, WhatAVerdictOffersIsPlannedAndNotUndercut) {
  testing::RandomProfiles random(31);
  for (int i = 0; i < 12; ++i) {
    const ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    const ProfileResult refused = solve_profile(in_time(request, TimeMode::time_budget, 1.0));
    ASSERT_TRUE(refused.infeasibility) << refused.summary.message;
    EXPECT_NE(refused.summary.message.find(" limits the fastest drive for "), std::string::npos)
        << refused.summary.message;
    const double offered_s = refused.infeasibility->relaxation.at("deadline_s");
    const ProfileResult plan = solve_profile(in_time(request, TimeMode::time_budget, offered_s));
    EXPECT_TRUE(plan.profile) << i << " " << plan.summary.message;
    EXPECT_FALSE(solve_profile(in_time(request, TimeMode::time_budget, offered_s * (1 - 1e-5))).profile) << i;
  }
}

/// Limits that leave long straights at full speed and hold at corners alone: a closed form of few nodes must
/// not pass between two checks of the replay.
TEST(LeastTime, WithAJerkLimitIsNotBelowThatWithout) {
  testing::RandomProfiles random(9);
  for (int i = 0; i < 8; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[2 + i % 2]);
    request.limits.speed_m_s = 0.65;
    request.limits.acceleration_m_s2 = request.limits.deceleration_m_s2 = 0.8;
    const double free_s = fastest(request).summary.lower_bound_s;
    request.limits.jerk_m_s3 = 1;
    const ProfileResult limited = fastest(request);
    ASSERT_TRUE(limited.profile) << limited.summary.message;
    EXPECT_GE(limited.profile->duration_s(), free_s) << i;
    EXPECT_GE(limited.summary.lower_bound_s, free_s * (1 - 1e-9)) << i;
  }
}

/// The limit that makes the drive slow is the one that is named.
TEST(LeastTime, TheLimitThatHoldsTheDriveIsNamed) {
  ProfileRequest request = testing::RandomProfiles(5).next(testing::PathClass::straight);
  request.piece = straight_piece({}, 30);
  EXPECT_NE(solve_profile(in_time(request, TimeMode::time_budget, 20)).summary.message.find("; speed limits"),
            std::string::npos);
  request.piece = straight_piece({}, 1.5);
  const std::string message = solve_profile(in_time(request, TimeMode::time_budget, 2)).summary.message;
  EXPECT_TRUE(message.find("; acceleration limits") != std::string::npos ||
              message.find("; deceleration limits") != std::string::npos)
      << message;
}

}  // namespace
}  // namespace joulepath
