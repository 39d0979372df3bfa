// The bound over all paths in plans of missions.
#include "planner/bound/path_bound.hpp"

#include <gtest/gtest.h>

#include "planner/mission/mission.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

Plan planned(const MissionRequest& mission, bool path_bound = true, double jerk_m_s3 = kNoLimit) {
  MissionWorld world{.robot = testing::nomad()};
  world.robot.limits->jerk_m_s3 = jerk_m_s3;
  world.robot.footprint.radius_m = 0.2;
  world.map = free_grid(240, 160, 0.05);
  return plan_mission(
      mission, world,
      {.solver = SolverChoice::fast, .nodes = 60, .baselines = false, .path_bound = path_bound});
}

MissionRequest two_legs() {
  MissionRequest mission;
  mission.stations = {{"a", {.x_m = 10, .y_m = 1.5}}, {"b", {.x_m = 10, .y_m = 6}}};
  mission.start.pose = {1, 1, 0};
  mission.legs = {{.to = "a", .dwell_s = 4}, {.to = "b", .payload = {3, 3}}};
  return mission;
}

TEST(PathBounds, LieBelowEachLegAndTheMissionAndAddUp) {
  const Plan plan = planned(two_legs());
  ASSERT_LE(plan.status, SolveStatus::feasible);
  double sum_J = 0;
  for (const LegPlan& leg : plan.legs) {
    ASSERT_TRUE(leg.path_bound && leg.path_bound->energy_J) << leg.to;
    EXPECT_LE(*leg.path_bound->energy_J, leg.energy.total_J()) << leg.to;
    EXPECT_GE(*leg.path_bound->energy_J, 0.6 * leg.energy.total_J()) << leg.to;
    sum_J += *leg.path_bound->energy_J;
  }
  ASSERT_TRUE(plan.path_bound && plan.path_bound->energy_J);
  EXPECT_NEAR(*plan.path_bound->energy_J, sum_J, 1e-6);
  EXPECT_FALSE(planned(two_legs(), false).path_bound);
}

/// Headings at the ends raise the bound, and no further than what a plan takes.
TEST(PathBounds, KnowTheHeadingsThatAMissionNames) {
  MissionRequest mission;
  mission.stations = {{"a", {.x_m = 7, .y_m = 5}}};
  mission.start.pose = {5, 5, 3.0};
  mission.legs = {{.to = "a"}};
  const Plan backward = planned(mission);
  ASSERT_LE(backward.status, SolveStatus::feasible) << backward.message;
  EXPECT_EQ(backward.path_bound->part, PathBound::Part::headings);
  EXPECT_LE(*backward.path_bound->energy_J, backward.energy.total_J());
  mission.start.pose.heading_rad = 0;
  const Plan ahead = planned(mission);
  EXPECT_EQ(ahead.path_bound->part, PathBound::Part::line);
  EXPECT_GT(*backward.path_bound->energy_J, *ahead.path_bound->energy_J + 3);
  mission.start.heading_given = false;
  mission.stations["a"].heading_rad = 3.0;
  const Plan turned = planned(mission);
  ASSERT_LE(turned.status, SolveStatus::feasible) << turned.message;
  EXPECT_EQ(turned.path_bound->part, PathBound::Part::headings);
  EXPECT_LE(*turned.path_bound->energy_J, turned.energy.total_J());
}

/// A deadline that is felt raises the bound, as it raises the plan.
TEST(PathBounds, ContainThePriceOfADeadline) {
  MissionRequest mission = two_legs();
  const Plan free = planned(mission);
  mission.objective.deadline_s = 0.99 * free.duration_s;
  const Plan hurried = planned(mission);
  ASSERT_LE(hurried.status, SolveStatus::feasible) << hurried.message;
  ASSERT_TRUE(hurried.path_bound && hurried.path_bound->energy_J);
  EXPECT_LE(*hurried.path_bound->energy_J, hurried.energy.total_J());
  EXPECT_GT(*hurried.path_bound->energy_J, *free.path_bound->energy_J);
}

/// A plan that hardly meets its deadline has any price of a second. No deadline lowers the bound of a later
/// one but by the factor between two prices that are tried.
TEST(PathBounds, TheTightestDeadlineNeverLowersThem) {
  MissionRequest mission = two_legs();
  mission.objective = {.minimize = Objective::Minimize::time};
  const double least_s = planned(mission).duration_s;
  mission.objective = {.minimize = Objective::Minimize::energy};
  double later_J = 0;
  for (const double share : {1.02, 1.0001}) {
    mission.objective.deadline_s = share * least_s;
    const Plan plan = planned(mission);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    ASSERT_TRUE(plan.path_bound && plan.path_bound->energy_J);
    EXPECT_GE(*plan.path_bound->energy_J, 0.93 * later_J) << share;
    EXPECT_LE(*plan.path_bound->energy_J, plan.energy.total_J()) << share;
    later_J = *plan.path_bound->energy_J;
  }
}

/// Under a jerk limit the price of a second, which is far above that without it, is no good multiplier. What
/// holds for all paths holds for the given ones.
TEST(PathBounds, LessTimeNeverLowersThem) {
  MissionRequest mission;
  mission.stations = {{"a", {.x_m = 5, .y_m = 1}}};
  mission.start.pose = {1, 1, 0};
  mission.legs = {{.to = "a"}};
  double before_J = 0;
  for (const double price_W : {0.0, 30.0, 300.0, 3000.0}) {
    mission.objective = {.minimize = Objective::Minimize::energy_and_time, .time_value_W = price_W};
    const Plan plan = planned(mission, true, 0.3);
    ASSERT_LE(plan.status, SolveStatus::feasible) << price_W << plan.message;
    ASSERT_TRUE(plan.path_bound && plan.path_bound->energy_J);
    EXPECT_GE(*plan.path_bound->energy_J, before_J - 1e-6) << price_W;
    EXPECT_GE(plan.lower_bound_J, *plan.path_bound->energy_J) << price_W;
    EXPECT_LE(plan.lower_bound_J, plan.energy.total_J()) << price_W;
    before_J = *plan.path_bound->energy_J;
  }
}

/// A leg of a given path has no bound over other paths; the mission's holds what that path takes at least.
TEST(PathBounds, GivenPathsCountWithTheirOwnBound) {
  MissionRequest mission = two_legs();
  const PathRequest line{.bezier_m = {{{{0, 0}, {0.4, 0}, {0.8, 0}, {1.2, 0}}}}};
  mission.legs.push_back({.to = "path", .path = line});
  const Plan free = planned(mission);
  mission.objective.deadline_s = 0.98 * free.duration_s;
  for (const Plan& plan : {free, planned(mission)}) {
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    EXPECT_EQ(plan.legs.back().path_bound->reason, "the leg's path is given");
    ASSERT_TRUE(plan.path_bound->energy_J);
    double searched_J = 0;
    for (std::size_t k : {0u, 1u}) searched_J += *plan.legs[k].path_bound->energy_J;
    EXPECT_NEAR(*plan.path_bound->energy_J - searched_J, plan.legs.back().lower_bound_J, 0.01);
    EXPECT_LE(*plan.path_bound->energy_J, plan.energy.total_J());
  }
  mission.legs = {{.to = "path", .path = line}};
  mission.objective.deadline_s.reset();
  const Plan given = planned(mission);
  EXPECT_FALSE(given.path_bound->energy_J);
  EXPECT_EQ(given.path_bound->reason, "leg 1 (path): the leg's path is given");
}

}  // namespace
}  // namespace joulepath
