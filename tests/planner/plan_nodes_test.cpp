// The written rows of a plan: one at every node, so that linear interpolation by a reader exceeds no limit,
// and energies that are exact at every row.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/accounts/edge_energy.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The paper's curve with payload, 6 m straight, and back along it: a turn in place.
MissionRequest there_and_back() {
  const auto leg = [](const BezierPoints& curve, double payload_kg) {
    return LegRequest{.path = PathRequest{.bezier_m = {curve}}, .payload = {payload_kg, payload_kg}};
  };
  MissionRequest mission{.name = "there_and_back",
                         .legs = {leg({{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}, 5.7),
                                  leg({{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}, 1.0),
                                  leg({{{0, 0}, {-1, 0}, {-2, 0}, {-3, 0}}}, 0.0)}};
  mission.legs[0].dwell_s = 5.0;
  return mission;
}

Plan plan_with(double jerk_m_s3, double eta) {
  Robot robot = testing::nomad();
  robot.power.regeneration_efficiency = eta;
  robot.limits->jerk_m_s3 = jerk_m_s3;
  return plan_mission(there_and_back(), {.robot = robot}, {.solver = SolverChoice::fast, .nodes = 60});
}

const Plant& plant_of(const Plan& plan) { return plan.legs[0].stretches[0].request.plant; }

/// Energy (J) of a leg from its departure to an instant of its driving by the midpoint rule of a fine grid.
double reference_J(const LegPlan& leg, double until_s) {
  constexpr int kParts = 2000;  // midpoint error about 1e-8 of a segment's share, 1e-10 after extrapolation
  double sum_J = 0, start_s = 0;
  for (const StretchPlan& stretch : leg.stretches) {
    const PathMotion motion = path_motion(stretch.request);
    const Profile& profile = stretch.profile;
    for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k) {
      const double from_s = profile.time_s[k], to_s = std::min(profile.time_s[k + 1], until_s - start_s);
      if (!(to_s > from_s)) continue;
      const double step_s = (to_s - from_s) / kParts;
      for (int i = 0; i < kParts; ++i)
        sum_J += step_s * drive_power_W(motion, profile.at_time(from_s + (i + 0.5) * step_s));
    }
    start_s += profile.duration_s();
  }
  return sum_J + until_s * leg.stretches[0].request.plant.robot.power.standby_W;
}

class PlanRows : public ::testing::TestWithParam<std::pair<double, double>> {
 protected:
  PlanRows() : plan_(plan_with(GetParam().first, GetParam().second)) {}
  Plan plan_;
};

TEST_P(PlanRows, EveryNodeOfEveryProfileHasOne) {
  ASSERT_EQ(plan_.legs.size(), 3u) << plan_.message;
  const PlanNodes nodes = plan_nodes(plan_, plant_of(plan_));
  for (const LegPlan& leg : plan_.legs) {
    double start_s = leg.start_s;
    for (const StretchPlan& stretch : leg.stretches) {
      for (double time_s : stretch.profile.time_s) {
        const auto& rows_s = nodes.rows.time_s;
        const auto near = std::lower_bound(rows_s.begin(), rows_s.end(), start_s + time_s - 1e-9);
        ASSERT_NE(near, rows_s.end());
        EXPECT_NEAR(*near, start_s + time_s, 1e-9);
      }
      start_s += stretch.profile.duration_s();
    }
  }
}

TEST_P(PlanRows, LinearInterpolationExceedsNoLimitOfSpeedAndAcceleration) {
  ASSERT_EQ(plan_.legs.size(), 3u) << plan_.message;
  const PlanNodes nodes = plan_nodes(plan_, plant_of(plan_));
  const Trajectory& rows = nodes.rows;
  constexpr double kSame = 1e-9;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double dt = rows.time_s[k + 1] - rows.time_s[k];
    ASSERT_GT(dt, 0);
    const auto leg = static_cast<std::size_t>(rows.leg[k]);
    const Limits& limits = plan_.legs[leg].stretches[0].request.limits;
    const double change = (rows.linear_speed_m_s[k + 1] - rows.linear_speed_m_s[k]) / dt;
    EXPECT_LE(std::abs(rows.linear_speed_m_s[k]), limits.speed_m_s * (1 + kSame));
    EXPECT_LE(std::abs(rows.angular_speed_rad_s[k]), limits.yaw_rate_rad_s * (1 + kSame));
    for (double a : {change, rows.linear_acceleration_m_s2[k]}) {
      EXPECT_LE(a, limits.acceleration_m_s2 * (1 + kSame)) << rows.time_s[k];
      EXPECT_GE(a, -limits.deceleration_m_s2 * (1 + kSame)) << rows.time_s[k];
    }
    EXPECT_NEAR(change, rows.linear_acceleration_m_s2[k] + 0.5 * nodes.linear_jerk_m_s3[k] * dt, 1e-7 / dt);
    if (std::isfinite(limits.jerk_m_s3)) {
      EXPECT_LE(std::abs(nodes.linear_jerk_m_s3[k]), limits.jerk_m_s3 * (1 + 1e-6));
    }
  }
}

TEST_P(PlanRows, EnergyIsExactAtEveryRow) {
  ASSERT_EQ(plan_.legs.size(), 3u) << plan_.message;
  const Trajectory uniform = plan_trajectory(plan_, plant_of(plan_));
  const PlanNodes nodes = plan_nodes(plan_, plant_of(plan_));
  const LegPlan& leg = plan_.legs[0];
  for (const Trajectory* rows : {&uniform, &nodes.rows})
    for (std::size_t k = 1; k < rows->size() && rows->time_s[k] < leg.duration_s;
         k += 1 + rows->size() / 12) {
      const double exact_J = reference_J(leg, rows->time_s[k]);
      EXPECT_NEAR(rows->energy_J[k], exact_J, 1e-9 * plan_.energy.total_J()) << rows->time_s[k];
    }
  EXPECT_NEAR(uniform.energy_J.back(), plan_.energy.total_J(), 1e-9 * plan_.energy.total_J());
  EXPECT_NEAR(nodes.rows.energy_J.back(), plan_.energy.total_J(), 1e-9 * plan_.energy.total_J());
  for (std::size_t k = 2; k + 1 < uniform.size(); ++k)
    EXPECT_NEAR(uniform.time_s[k] - uniform.time_s[k - 1], 0.02, 1e-9);
}

/// The rows of a plan by edges and stops follow each other without a gap, and add up to the plan. The first
/// leg is cut in three named parts.
TEST(EdgeEnergies, AddUpToThePlan) {
  Plan plan = plan_with(kNoLimit, 0.6);
  ASSERT_EQ(plan.legs.size(), 3u) << plan.message;
  const double length_m = plan.legs[0].distance_m;
  plan.legs[0].parts = {{"first", 0, 0.2 * length_m},
                        {"second", 0.2 * length_m, 0.7 * length_m},
                        {"third", 0.7 * length_m, length_m}};
  const std::vector<EdgeEnergy> edges = edge_energies(plan, plant_of(plan));
  double now_s = 0, energy_J = 0, distance_m = 0;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    EXPECT_NEAR(edges[k].start_s, now_s, 1e-9) << k;
    now_s += edges[k].duration_s, energy_J += edges[k].energy.total_J(), distance_m += edges[k].distance_m;
    if (k == 0) continue;
    EXPECT_NEAR(edges[k].from.x_m, edges[k - 1].to.x_m, 1e-6) << k;
    EXPECT_NEAR(edges[k].from.y_m, edges[k - 1].to.y_m, 1e-6) << k;
  }
  EXPECT_NEAR(now_s, plan.duration_s, 1e-6);
  EXPECT_NEAR(energy_J, plan.energy.total_J(), 1e-6 * energy_J);
  EXPECT_NEAR(distance_m, plan.distance_m, 1e-6);
  ASSERT_GE(edges.size(), 4u);
  EXPECT_EQ(edges[1].name, "second");
  EXPECT_NEAR(edges[1].distance_m, 0.5 * length_m, 1e-9);
  EXPECT_EQ(edges[3].kind, EdgeEnergy::Kind::dwell);
}

/// While the robot stands at a stop its motors take nothing; where it starts they accelerate it.
TEST(PlanTrajectory, HasNoCurrentAtAStopAndOneAtTheStart) {
  const Plan plan = plan_with(kNoLimit, 0.6);
  ASSERT_EQ(plan.legs.size(), 3u) << plan.message;
  const double standby_W = plant_of(plan).robot.power.standby_W, arrival_s = plan.legs[0].duration_s;
  const Trajectory rows = plan_trajectory_at(plan, plant_of(plan), {0.0, arrival_s + 0.5, arrival_s + 4.5});
  EXPECT_GT(rows.motor_current_A.left[0], 0.1);
  for (const std::size_t stopped : {1u, 2u}) {
    EXPECT_EQ(rows.motor_current_A.left[stopped], 0.0);
    EXPECT_EQ(rows.motor_voltage_V.right[stopped], 0.0);
    EXPECT_NEAR(rows.battery_power_W[stopped], standby_W, 1e-12);
  }
}

TEST(Saving, IsTheShareOfTheBaseline) {
  EXPECT_NEAR(saving_percent(180, 200), 10, 1e-12);
  EXPECT_NEAR(saving_percent(250, 200), -25, 1e-12);
  EXPECT_EQ(saving_percent(1, 0), 0.0);
}

INSTANTIATE_TEST_SUITE_P(JerkAndRegeneration, PlanRows,
                         ::testing::Values(std::pair{kNoLimit, 0.0}, std::pair{kNoLimit, 0.6},
                                           std::pair{1.0, 0.6}));

/// Twice around a loop on the map: the heading goes on where it was, in both files.
TEST(PlanHeadings, FollowEachOtherOverFullTurns) {
  const std::vector<BezierPoints> loop{{{{0, 0}, {1.1, 0}, {2, 0.9}, {2, 2}}},
                                       {{{2, 2}, {2, 3.1}, {1.1, 4}, {0, 4}}},
                                       {{{0, 4}, {-1.1, 4}, {-2, 3.1}, {-2, 2}}},
                                       {{{-2, 2}, {-2, 0.9}, {-1.1, 0}, {0, 0}}}};
  const LegRequest around{.path = PathRequest{.bezier_m = loop, .frame = PathRequest::Frame::map}};
  const Plan plan = plan_mission({.name = "loops", .legs = {around, around}}, {.robot = testing::nomad()},
                                 {.solver = SolverChoice::fast, .nodes = 60});
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  const Plant plant = make_plant(testing::nomad());
  for (const Trajectory& rows : {plan_trajectory(plan, plant), plan_nodes(plan, plant).rows}) {
    for (std::size_t k = 1; k < rows.size(); ++k)
      ASSERT_LE(std::abs(rows.heading_rad[k] - rows.heading_rad[k - 1]),
                2.0 * (rows.time_s[k] - rows.time_s[k - 1]) + 1e-5)
          << k;
    EXPECT_NEAR(rows.heading_rad.back() - rows.heading_rad.front(), 4 * std::numbers::pi, 1e-6);
  }
}

}  // namespace
}  // namespace joulepath
