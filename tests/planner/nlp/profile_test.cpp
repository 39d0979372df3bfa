
#include "planner/values/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/baselines/baseline.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

ProfileRequest straight_request(double length_m, const Robot& robot = testing::nomad()) {
  return {.piece = straight_piece({}, length_m),
          .plant = make_plant(robot),
          .limits = robot.limits.value_or(Limits{})};
}

/// A quarter turn of a cubic Bezier, as the paper drives it.
PathPiece bezier_piece() { return Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}); }

/// A roll that begins and ends almost as a turn in place: half of its time passes on a hundredth of its
/// length.
PathPiece nearly_turning_piece() {
  std::vector<CurveSegment> segments;
  Pose here;
  for (const auto& [from_rad, to_rad, length_m] :
       {std::array{1.56, 1.3, 0.09}, {1.3, 0.2, 0.3}, {0.2, 0.0, 0.9}, {0.0, 1.3, 0.3}, {1.3, 1.56, 0.09}}) {
    const DirectionSegment next(here, {from_rad, to_rad, length_m, testing::nomad().geometry.half_track_m});
    here = next.at(next.length_m()).pose;
    segments.push_back(next);
  }
  return Curve(std::move(segments));
}

TEST(Profile, OnFewNodesCostsLittleMoreWhereAPathNearlyTurnsInPlace) {
  const Plant plant = make_plant(testing::nomad());
  ProfileRequest request{.piece = nearly_turning_piece(),
                         .plant = plant,
                         .limits = *plant.robot.limits,
                         .solver = SolverChoice::fast};
  const auto energy_J = [&](std::size_t nodes) {
    request.nodes = nodes;
    const ProfileResult result = solve_profile(request);
    return result.profile ? replay(request, *result.profile).energy_J : 0.0;
  };
  const double finest_J = energy_J(1500);
  ASSERT_GT(finest_J, 0);
  for (const std::size_t nodes : {60, 200}) {
    EXPECT_LT(energy_J(nodes), 1.005 * finest_J) << nodes;
    EXPECT_GT(energy_J(nodes), 0.999 * finest_J) << nodes;
  }
}

TEST(Profile, StraightLineMeetsTheClosedForm) {
  Robot robot = testing::nomad();
  robot.inertia.wheel_axle_inertia_kg_m2 = 0.148 - 23.98 * 0.01 / 2;
  robot.power = {.standby_W = 0.0, .regeneration_efficiency = 1.0};
  ProfileRequest request = straight_request(10.0, robot);
  request.time = {TimeMode::fixed_time, 17.3694};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_NEAR(replay(request, *result.profile).energy_J, 79.5060763, 79.5060763 * 1e-6);
}

TEST(Profile, KeepsEveryLimitBetweenNodes) {
  ProfileRequest request = straight_request(1.0);
  request.piece = bezier_piece();
  for (TimeMode mode :
       {TimeMode::free_time, TimeMode::minimum_time, TimeMode::time_budget, TimeMode::fixed_time}) {
    request.time = {mode, 12.0};
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << again.limit << " " << again.worst_violation << " at " << again.s;
    EXPECT_NEAR(again.end_s, piece_length(request.piece), 1e-6);
    EXPECT_NEAR(again.energy_J, energy_by_cause(path_motion(request), *result.profile).total_J(),
                1e-5 * again.energy_J);
  }
}

TEST(Profile, TakesNoMoreThanTheTrapezoids) {
  ProfileRequest request = straight_request(1.0);
  request.piece = bezier_piece();
  request.time = {TimeMode::fixed_time, 14.0};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  const double energy_J = replay(request, *result.profile).energy_J;
  for (const BaselineResult& baseline :
       {trapezoid_max_acceleration(request, 14.0), trapezoid_best_tuned(request, 14.0)}) {
    EXPECT_TRUE(baseline.feasible) << baseline.name << ": " << baseline.reason;
    EXPECT_NEAR(baseline.profile->duration_s(), 14.0, 1e-5);
    EXPECT_LT(energy_J, baseline.energy_J);
  }
}

TEST(Profile, ATunedTrapezoidKeepsTheYawAccelerationThroughACorner) {
  std::vector<CurveSegment> segments{LinearCurvature({}, 2.0)};
  segments.emplace_back(LinearCurvature({2.0, 0, 0}, 0.4, 0, 1.5 / 0.4));
  segments.emplace_back(
      LinearCurvature(std::get<LinearCurvature>(segments.back()).at(0.4).pose, 0.4, 1.5, -1.5 / 0.4));
  segments.emplace_back(LinearCurvature(std::get<LinearCurvature>(segments.back()).at(0.4).pose, 2.0));
  ProfileRequest request = straight_request(1.0);
  request.piece = Curve(std::move(segments));
  request.limits.yaw_acceleration_rad_s2 = 1.0;
  request.time = {TimeMode::minimum_time};
  const double least_s = solve_profile(request).profile->duration_s();
  for (double slack : {1.03, 1.2}) {
    request.time = {TimeMode::fixed_time, slack * least_s};
    const double energy_J = replay(request, *solve_profile(request).profile).energy_J;
    const BaselineResult tuned = trapezoid_best_tuned(request, slack * least_s);
    EXPECT_TRUE(tuned.feasible) << tuned.reason;
    EXPECT_GT(tuned.energy_J, energy_J);
    EXPECT_LE(tuned.energy_J, trapezoid_max_acceleration(request, slack * least_s).energy_J * (1 + 1e-6));
  }
  EXPECT_FALSE(trapezoid_best_tuned(request, 0.9 * least_s).feasible);
}

TEST(Profile, AJumpOfAccelerationBreaksAJerkLimit) {
  ProfileRequest request = straight_request(8.0);
  const Profile profile = *solve_profile(request).profile;
  EXPECT_TRUE(replay(request, profile).valid());
  request.limits.jerk_m_s3 = 100;
  EXPECT_EQ(replay(request, profile).limit, "jerk");
}

TEST(Profile, TurnsInPlaceWithHeadingAsThePath) {
  ProfileRequest request = straight_request(1.0);
  request.piece = TurnInPlace{{}, -1.5};
  request.time = {TimeMode::time_budget, 4.0};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_TRUE(replay(request, *result.profile).valid());
  EXPECT_LE(result.profile->duration_s(), 4.0 * (1 + 1e-9));
}

TEST(Profile, APlanWithDragInItsModelDiffersAndTakesLessEnergy) {
  const Robot robot = testing::nomad();
  ProfileRequest nominal = straight_request(8.0, robot), knowing = nominal;
  knowing.plant =
      make_plant(robot, {{.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 20}}}});
  nominal.time = knowing.time = {TimeMode::fixed_time, 12.0};
  const Profile with = *solve_profile(knowing).profile, without = *solve_profile(nominal).profile;
  const double top = *std::max_element(with.rate.begin(), with.rate.end()),
               nominal_top = *std::max_element(without.rate.begin(), without.rate.end());
  EXPECT_LT(top, 0.98 * nominal_top) << "drag asks for an even speed";
  const auto motion_J = [](const ProfileRequest& request, const Profile& profile) {
    return replay(request, profile).motion_energy_J;
  };
  EXPECT_LT(motion_J(knowing, with), 0.999 * motion_J(knowing, without));
  EXPECT_LT(motion_J(nominal, without), 0.999 * motion_J(nominal, with)) << "and each is the best at home";
}

TEST(Profile, MissedDeadlineSaysByHowMuch) {
  ProfileRequest request = straight_request(10.0);
  request.time = {TimeMode::minimum_time};
  const double minimum_s = solve_profile(request).profile->duration_s();
  EXPECT_NEAR(minimum_s, 12.0, 1e-3);  // 1 m/s, 0.5 m/s^2: 10/1 + 1/0.5
  request.time = {TimeMode::time_budget, 11.0};
  const ProfileResult result = solve_profile(request);
  EXPECT_EQ(result.summary.status, SolveStatus::infeasible);
  ASSERT_TRUE(result.infeasibility.has_value());
  EXPECT_EQ(result.infeasibility->constraint, "deadline");
  EXPECT_NEAR(result.infeasibility->amount, 1.0, 1e-3);
}

TEST(Profile, StartSpeedThatCannotBeShedIsNamed) {
  ProfileRequest request = straight_request(0.5);
  request.start_rate = 1.0;  // sheds 0.5 m/s^2 over 0.5 m: sqrt(0.5) m/s at most
  const ProfileResult result = solve_profile(request);
  EXPECT_EQ(result.summary.status, SolveStatus::infeasible);
  ASSERT_TRUE(result.infeasibility.has_value());
  EXPECT_EQ(result.infeasibility->constraint, "start_speed");
  EXPECT_NEAR(result.infeasibility->relaxation.at("start_speed_m_s"), std::sqrt(0.5), 1e-3);
}

}  // namespace
}  // namespace joulepath
