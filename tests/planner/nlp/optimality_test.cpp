#include <gtest/gtest.h>

#include <cmath>

#include "planner/baselines/baseline.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/profile/front.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath {
namespace {

/// Least cost of all profiles whose squares of the rate lie on a grid: dynamic programming, no derivative,
/// no solver. Costs of segments come from the transcription.
double dynamic_programming_J(const nlp::Problem& problem, int levels) {
  const std::size_t last = problem.segment_count();
  const auto level = [&](std::size_t node, int i) {
    if (node == 0) return problem.b_start;
    if (node == last) return problem.b_end;
    const double share = (i + 1.0) / levels;
    return problem.cap[node].squared * share * share;
  };
  const auto count = [&](std::size_t node) { return node == 0 || node == last ? 1 : levels; };
  std::vector<double> cost(1, 0.0);
  for (std::size_t k = 0; k < last; ++k) {
    std::vector<double> next(static_cast<std::size_t>(count(k + 1)), kNoLimit);
    for (int i = 0; i < count(k); ++i)
      for (int j = 0; j < count(k + 1); ++j) {
        const auto interval = nlp::plain_interval(problem.segments[k], level(k, i), level(k + 1, j));
        bool allowed = interval.dt < 1e3;
        for (std::size_t r = problem.first_row[k]; allowed && r < problem.first_row[k + 1]; ++r) {
          const double value = evaluate_row(problem, problem.rows[r], interval);
          allowed = value <= problem.rows[r].bounds.high && value >= problem.rows[r].bounds.low;
        }
        if (!allowed) continue;
        double sum_J = problem.time_weight_W * interval.dt;
        for (double energy_J : nlp::Energy::both(interval))
          sum_J += energy_J + problem.recovery_weight * std::max(0.0, -energy_J);
        double& best = next[static_cast<std::size_t>(j)];
        best = std::min(best, cost[static_cast<std::size_t>(i)] + sum_J);
      }
    cost = std::move(next);
  }
  return cost.front();
}

TEST(Optimality, DynamicProgrammingFindsNothingBetterAndComesClose) {
  testing::RandomProfiles random(99);
  for (int i = 0; i < 8; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    request.nodes = 24;
    request.solver = SolverChoice::fast;
    request.accuracy = 1.0;  // no refinement: the same grid for both
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
    const PathMotion motion = path_motion(request);
    const nlp::Problem problem = nlp::transcribe(request, motion, result.profile->s, {}, nullptr);
    double planned_J = 0;
    for (std::size_t k = 0; k < problem.segment_count(); ++k) {
      const double u0 = result.profile->rate[k], u1 = result.profile->rate[k + 1];
      const auto interval = nlp::plain_interval(problem.segments[k], u0 * u0, u1 * u1);
      planned_J += problem.time_weight_W * interval.dt;
      for (double energy_J : nlp::Energy::both(interval))
        planned_J += energy_J + problem.recovery_weight * std::max(0.0, -energy_J);
    }
    const double dynamic_J = dynamic_programming_J(problem, 300);
    EXPECT_GE(dynamic_J, planned_J * (1 - 1e-4)) << i;
    EXPECT_GE(dynamic_J, result.summary.lower_bound_J) << i;
    EXPECT_LE(dynamic_J, planned_J * (1 + 5e-3)) << i;
  }
}

TEST(Optimality, CertificateCoversTheExcessOverAFineGrid) {
  testing::RandomProfiles random(41);
  for (int i = 0; i < 12; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    request.solver = SolverChoice::fast;
    const ProfileResult coarse = solve_profile(request);
    request.nodes = 1600;
    const ProfileResult fine = solve_profile(request);
    ASSERT_TRUE(coarse.profile && fine.profile) << coarse.summary.message << fine.summary.message;
    const PathMotion motion = path_motion(request);
    const double fine_J = energy_by_cause(motion, *fine.profile).total_J();
    const double coarse_J = energy_by_cause(motion, *coarse.profile).total_J();
    EXPECT_GE(fine_J, coarse.summary.lower_bound_J) << i;
    EXPECT_LE(coarse_J, fine_J * (1 + 1e-3)) << i;
  }
}

/// More time than any speed is worth: without a price of time only friction's standing loss limits the
/// duration, and parts of copper loss that are not convex alone must be treated together.
ProfileRequest long_drive() {
  Robot robot = testing::nomad();
  robot.power.standby_W = 0;
  return {.piece = straight_piece({}, 4.24),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .payload = {5, 5},
          .time = {.mode = TimeMode::time_price, .duration_s = 12, .price_W = 1e-3},
          .solver = SolverChoice::fast};
}

TEST(Optimality, ALongDriveIsCertifiedAndNoClassicProfileIsBelowItsBound) {
  const ProfileRequest request = long_drive();
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile) << result.summary.message;
  EXPECT_EQ(result.summary.status, SolveStatus::optimal);
  EXPECT_LT(result.summary.gap_percent, 0.01);
  for (const BaselineResult& baseline : all_baselines(request, 12)) {
    if (!baseline.feasible) continue;
    EXPECT_GE(baseline.motion_energy_J + 1e-3 * 12, result.summary.lower_bound_J) << baseline.name;
  }
}

/// T^4 = 36 R alpha^2 D^2/(R beta^2 + P0): free time with idle power, without viscous friction and limits.
TEST(Optimality, FreeTimeOfAStraightLineMeetsTheClosedForm) {
  Robot robot = testing::nomad();
  for (Motor* motor : {&robot.motor.left, &robot.motor.right}) {
    motor->viscous_friction_Nm_s_rad = 0;
    motor->friction_torque_Nm = 0.36;
    motor->max_voltage_V = motor->max_current_A = kNoLimit;
  }
  robot.power = {.standby_W = 6.0, .regeneration_efficiency = 1.0};
  const double length_m = 8;
  ProfileRequest request{
      .piece = straight_piece({}, length_m), .plant = make_plant(robot), .limits = {.speed_m_s = 50}};
  request.time = {TimeMode::free_time};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  // Copper loss of both motors: 2 R (tau/(Kt n))^2, tau = J a/r + T_m.
  const Motor& motor = robot.motor.left;
  const double r = 0.1, k = motor.torque_per_ampere_Nm_A();
  const double J = robot.total_mass_kg(0) * r * r / 2 + robot.inertia.wheel_axle_inertia_kg_m2;
  const double alpha = J / r / k, beta = motor.friction_torque_Nm / k, R2 = 2 * motor.resistance_ohm;
  const double T = std::pow(36 * R2 * alpha * alpha * length_m * length_m / (R2 * beta * beta + 6.0), 0.25);
  EXPECT_NEAR(result.profile->duration_s(), T, 1e-3 * T);
}

/// A second of such a standby is worth any energy of motion.
TEST(Front, IsOnePointWhereTheLeastTimeIsTheCheapest) {
  testing::RandomProfiles random(8);
  ProfileRequest request = random.next(testing::PathClass::bezier);
  request.solver = SolverChoice::fast;
  request.plant.robot.power.standby_W = 1e7;
  const Front front = energy_time_front({{request}}, 12);
  ASSERT_EQ(front.points.size(), 1u);
  EXPECT_NE(front.summary.message, "");
  request.time = {.mode = TimeMode::minimum_time};
  EXPECT_NEAR(front.points[0].duration_s, solve_profile(request).profile->duration_s(),
              1e-4 * front.points[0].duration_s);
}

TEST(Front, SlopesAreThePricesAndEveryPointIsAPlan) {
  testing::RandomProfiles random(8);
  ProfileRequest request = random.next(testing::PathClass::bezier);
  request.solver = SolverChoice::fast;
  const Front front = energy_time_front({{request}}, 40);
  ASSERT_EQ(front.points.size(), 40u);
  for (std::size_t k = 1; k < front.points.size(); ++k) {
    EXPECT_GT(front.points[k].duration_s, front.points[k - 1].duration_s);
    EXPECT_LT(front.points[k].energy_J, front.points[k - 1].energy_J);
    const double chord_W = (front.points[k - 1].energy_J - front.points[k].energy_J) /
                           (front.points[k].duration_s - front.points[k - 1].duration_s);
    EXPECT_LE(chord_W, front.points[k - 1].price_of_time_W * (1 + 1e-3) + 1e-3);
    // The first point is the least time, at any cost: nothing is optimized there.
    if (k == 1) continue;
    EXPECT_GE(chord_W, front.points[k].price_of_time_W * (1 - 1e-3) - 1e-3);
  }
  const FrontPoint& middle = front.points[20];
  request.time = {TimeMode::fixed_time, middle.duration_s};
  const ProfileResult plan = solve_profile(request);
  ASSERT_TRUE(plan.profile.has_value());
  EXPECT_NEAR(replay(request, *plan.profile).energy_J, middle.energy_J, 1e-4 * middle.energy_J);
  EXPECT_NEAR(plan.summary.price_of_time_W, middle.price_of_time_W, 1e-2 * (1 + middle.price_of_time_W));
}

}  // namespace
}  // namespace joulepath
