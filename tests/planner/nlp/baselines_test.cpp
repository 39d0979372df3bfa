// Classic profiles: at the plan's distance and time, within every limit or not at all.
#include <gtest/gtest.h>

#include <cmath>

#include "planner/baselines/baseline.hpp"
#include "planner/baselines/comparison.hpp"
#include "planner/motion/replay.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

ProfileRequest straight_line(double length_m) {
  const Robot robot = testing::nomad();
  return {.piece = straight_piece({}, length_m), .plant = make_plant(robot), .limits = *robot.limits};
}

/// Straight, a corner of 0.5 m radius through clothoids, straight.
ProfileRequest corner() {
  std::vector<CurveSegment> segments{LinearCurvature({}, 3.0)};
  segments.emplace_back(LinearCurvature({3.0, 0, 0}, 0.75, 0, 2.0 / 0.75));
  segments.emplace_back(
      LinearCurvature(std::get<LinearCurvature>(segments.back()).at(0.75).pose, 0.75, 2.0, -2.0 / 0.75));
  segments.emplace_back(LinearCurvature(std::get<LinearCurvature>(segments.back()).at(0.75).pose, 3.0));
  ProfileRequest request = straight_line(1);
  request.piece = Curve(std::move(segments));
  return request;
}

double least_s(ProfileRequest request) {
  request.time = {.mode = TimeMode::minimum_time};
  return solve_profile(request).profile->duration_s();
}

const BaselineResult& named(const std::vector<BaselineResult>& results, const std::string& name) {
  for (const BaselineResult& result : results)
    if (result.name == name) return result;
  ADD_FAILURE() << "no baseline " << name;
  return results.front();
}

/// Checked by the replay, which is independent of the baselines' own checks.
void expect_honest(const ProfileRequest& request, const std::vector<BaselineResult>& results, double T) {
  for (const BaselineResult& result : results) {
    if (!result.feasible) {
      EXPECT_FALSE(result.reason.empty()) << result.name;
      continue;
    }
    ASSERT_TRUE(result.profile.has_value()) << result.name;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid(2e-6)) << result.name << ": " << again.limit << " " << again.worst_violation;
    EXPECT_NEAR(again.duration_s, T, 1e-6 * T) << result.name;
    EXPECT_NEAR(again.end_s, piece_length(request.piece), 1e-6) << result.name;
    EXPECT_NEAR(again.energy_J, result.energy_J, 1e-5 * again.energy_J) << result.name;
    EXPECT_NEAR(result.profile->rate.front(), request.start_rate, 1e-9) << result.name;
    EXPECT_NEAR(result.profile->rate.back(), request.end_rate, 1e-9) << result.name;
  }
}

TEST(Baselines, EveryShapeIsClippedToTheCornerAndKeepsDistanceAndTime) {
  ProfileRequest request = corner();
  const double T = 1.3 * least_s(request);
  const std::vector<BaselineResult> results = all_baselines(request, T);
  expect_honest(request, results, T);
  for (const char* name :
       {"trapezoid_max_acceleration", "trapezoid_best_tuned", "triangular", "constant_ramp", "s_curve",
        "cubic", "quintic", "sinusoidal", "minimum_time_then_wait"})
    EXPECT_TRUE(named(results, name).feasible) << name << ": " << named(results, name).reason;
  EXPECT_EQ(named(results, "constant_speed").reason, "needs a step of speed at the ends");
}

TEST(Baselines, NoneIsCheaperThanThePlan) {
  ProfileRequest request = corner();
  const double T = 1.3 * least_s(request);
  request.time = {.mode = TimeMode::fixed_time, .duration_s = T};
  const double plan_J = replay(request, *solve_profile(request).profile).energy_J;
  for (const BaselineResult& result : all_baselines(request, T))
    if (result.feasible) {
      EXPECT_GE(result.energy_J, plan_J * (1 - 1e-5)) << result.name;
    }
}

TEST(Baselines, UnclippedShapesAreTheTextbooks) {
  ProfileRequest request = straight_line(10);
  const double T = 25;
  const std::vector<BaselineResult> results = all_baselines(request, T);
  expect_honest(request, results, T);
  const auto peak = [&](const char* name) {
    double most = 0;
    for (double rate : named(results, name).profile->rate) most = std::max(most, rate);
    return most * T / 10;
  };
  EXPECT_NEAR(peak("triangular"), 2, 1e-3);
  EXPECT_NEAR(peak("cubic"), 1.5, 1e-4);
  EXPECT_NEAR(peak("quintic"), 1.875, 1e-4);
  EXPECT_NEAR(peak("sinusoidal"), 2, 1e-4);
  EXPECT_NEAR(peak("constant_ramp"), T / (T - 4), 1e-6);
}

TEST(Baselines, ASpeedZoneClipsThem) {
  ProfileRequest request = straight_line(10);
  request.speed_caps = {{4, 6, 0.4}};
  const double T = 1.2 * least_s(request);
  const std::vector<BaselineResult> results = all_baselines(request, T);
  expect_honest(request, results, T);
  EXPECT_TRUE(named(results, "quintic").feasible) << named(results, "quintic").reason;
  EXPECT_NEAR(named(results, "quintic").profile->at_s(5).rate, 0.4, 1e-6);
}

TEST(Baselines, InfeasibleTimesAreReported) {
  ProfileRequest request = corner();
  const std::vector<BaselineResult> results = all_baselines(request, 0.99 * least_s(request));
  for (const BaselineResult& result : results) EXPECT_FALSE(result.feasible) << result.name;
  EXPECT_FALSE(named(results, "sinusoidal").feasible);
  EXPECT_FALSE(named(results, "sinusoidal").reason.empty());
}

TEST(Baselines, ATooSlowFastestDriveIsComparedAtItsOwnTime) {
  const ProfileRequest request = corner();
  const double fastest_s = least_s(request), T = 0.97 * fastest_s;
  for (const Baseline& baseline : baselines()) {
    const BaselineResult late = soonest(baseline, request, T);
    if (late.name != "minimum_time_then_wait") continue;
    ASSERT_TRUE(late.feasible) << late.reason;
    EXPECT_NEAR(late.duration_s, fastest_s, 1e-6 * fastest_s);
    return;
  }
  FAIL() << "no such baseline";
}

TEST(Baselines, TheLaterProfileFoundIsNearlyTheSoonest) {
  const ProfileRequest request = corner();
  const double T = 0.97 * least_s(request);
  int found = 0;
  for (const Baseline& baseline : baselines()) {
    const BaselineResult late = soonest(baseline, request, T);
    if (!late.feasible || late.duration_s <= T * (1 + 1e-9) || late.name == "minimum_time_then_wait")
      continue;
    ++found;
    EXPECT_FALSE(baseline(request, late.duration_s - 2e-3 * T).feasible) << late.name;
  }
  EXPECT_GE(found, 3) << "no profile keeps this time";
}

TEST(Baselines, EnergyOfTheBestTrapezoidIsContinuousInTime) {
  ProfileRequest request = straight_line(1);
  request.piece = curve_through({{0, 0}, {2, 0.3}, {4, -0.5}, {6, 1}, {7, 3}}).path.pieces.front();
  const double least = least_s(request), standby_W = request.plant.robot.power.standby_W;
  double before_J = 0, before_s = 0;
  for (double factor : {1.02, 1.024, 1.028, 1.032, 1.036, 1.04}) {
    const BaselineResult tuned = trapezoid_best_tuned(request, factor * least);
    ASSERT_TRUE(tuned.feasible) << factor << ": " << tuned.reason;
    if (before_s > 0) {
      EXPECT_LT(tuned.energy_J, 1.003 * (before_J + standby_W * (factor * least - before_s))) << factor;
    }
    before_J = tuned.energy_J, before_s = factor * least;
  }
}

TEST(Baselines, UnderAJerkLimitOnlySmoothOnesCount) {
  ProfileRequest request = straight_line(10);
  request.limits.jerk_m_s3 = 0.5;
  const std::vector<BaselineResult> results = all_baselines(request, 25);
  expect_honest(request, results, 25);
  EXPECT_FALSE(named(results, "triangular").feasible);
  EXPECT_TRUE(named(results, "s_curve").feasible) << named(results, "s_curve").reason;
}

TEST(Baselines, UnderAJerkLimitTrapezoidsAreRoundedAndClippedToTheCorner) {
  for (double jerk_m_s3 : {0.4, 1.0}) {
    ProfileRequest request = corner();
    request.limits.jerk_m_s3 = jerk_m_s3;
    request.solver = SolverChoice::fast;
    const double T = 1.35 * least_s(request);
    const std::vector<BaselineResult> results = all_baselines(request, T);
    expect_honest(request, results, T);
    request.time = {.mode = TimeMode::fixed_time, .duration_s = T};
    const double plan_J = replay(request, *solve_profile(request).profile).energy_J;
    for (const char* name : {"trapezoid_max_acceleration", "trapezoid_best_tuned", "s_curve"}) {
      const BaselineResult& result = named(results, name);
      ASSERT_TRUE(result.feasible) << jerk_m_s3 << " " << name << ": " << result.reason;
      EXPECT_GT(result.energy_J, plan_J * (1 - 1e-5)) << name;
    }
    EXPECT_LE(named(results, "trapezoid_best_tuned").energy_J,
              named(results, "trapezoid_max_acceleration").energy_J * (1 + 1e-9));
    EXPECT_NE(named(results, "triangular").reason.find("acceleration jumps"), std::string::npos);
  }
}

TEST(Baselines, ARoundedTrapezoidOnAStraightLineIsTheSCurve) {
  ProfileRequest request = straight_line(10);
  request.limits.jerk_m_s3 = 0.5;
  const double T = 15;
  const BaselineResult rounded = trapezoid_max_acceleration(request, T);
  ASSERT_TRUE(rounded.feasible) << rounded.reason;
  EXPECT_NEAR(rounded.energy_J, named(all_baselines(request, T), "s_curve").energy_J,
              1e-6 * rounded.energy_J);
}

/// A profile that is later than the plan stands beside the least energy in its own time, one that keeps the
/// plan's time beside the plan.
TEST(Baselines, EachIsComparedAtItsOwnTime) {
  for (const double jerk_m_s3 : {kNoLimit, 0.6})
    for (const double slower : {1.0005, 1.3}) {
      ProfileRequest request = corner();
      request.limits.jerk_m_s3 = jerk_m_s3;
      request.nodes = 60;
      request.solver = SolverChoice::fast;
      const double planned_s = slower * least_s(request);
      const EnergyByCause planned = *least_energy(request, planned_s);
      for (const Baseline& family : {Baseline(trapezoid_max_acceleration), Baseline(trapezoid_best_tuned)}) {
        const BaselineResult result = soonest(family, request, planned_s);
        if (!result.feasible) continue;
        BaselineTotal total;
        add_result(total, result, {&request, planned_s, planned});
        EXPECT_DOUBLE_EQ(total.later_s, std::max(0.0, result.duration_s - planned_s));
        request.time = {.mode = TimeMode::fixed_time, .duration_s = result.duration_s};
        const ReplayResult optimum = replay(request, *solve_profile(request).profile);
        EXPECT_NEAR(optimum.duration_s, total.duration_s, 1e-6 * total.duration_s);
        EXPECT_NEAR(total.optimum_J, optimum.energy_J, 1e-4 * optimum.energy_J) << slower << " " << jerk_m_s3;
        EXPECT_NEAR(total.optimum_motion_J, optimum.motion_energy_J, 2e-4 * optimum.energy_J);
        EXPECT_GE(total.energy_J, total.optimum_J * (1 - 1e-4));
      }
    }
}

TEST(Baselines, ConstantSpeedIsABaselineBetweenEqualEndSpeeds) {
  ProfileRequest request = straight_line(10);
  request.start_rate = request.end_rate = 0.5;
  const std::vector<BaselineResult> results = all_baselines(request, 20);
  expect_honest(request, results, 20);
  EXPECT_TRUE(named(results, "constant_speed").feasible) << named(results, "constant_speed").reason;
  EXPECT_EQ(named(results, "triangular").reason, "defined from rest to rest only");
}

}  // namespace
}  // namespace joulepath
