#include <gtest/gtest.h>

#include <cmath>

#include "planner/legs/on_ways.hpp"
#include "planner/mission/mission.hpp"
#include "planner/mission/plan_front.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// 15 m x 10 m: three racks whose gaps lie to and fro, and a free aisle north of them, which is longer.
OccupancyGrid floor_with_gaps() {
  OccupancyGrid grid = free_grid(150, 100, 0.1);
  const auto fill = [&](int column, int row0, int row1) {
    for (int row = row0; row < row1; ++row)
      for (int k = column; k < column + 8; ++k)
        grid.occupancy_percent[static_cast<std::size_t>(row * 150 + k)] = 100;
  };
  for (const int column : {40, 70, 100}) {
    const int gap = column == 70 ? 50 : 30;
    fill(column, 0, gap);
    fill(column, gap + 12, 84);
  }
  return grid;
}

struct FrontCase {
  MissionRequest mission{};
  MissionWorld world{};
};

/// To a place with any heading there.
FrontCase front_case(OccupancyGrid map, const Pose& start, double x_m, double y_m) {
  FrontCase made{.mission = {.name = "front", .clearance_m = 0.05},
                 .world = {.robot = testing::nomad(), .map = std::move(map)}};
  made.mission.stations = {{"goal", {.x_m = x_m, .y_m = y_m}}};
  made.mission.start = {.pose = start};
  made.mission.legs = {{.to = "goal", .dwell_s = 3}};
  return made;
}

FrontCase through_gaps() { return front_case(floor_with_gaps(), {1.5, 5, 0}, 13, 5); }

FrontCase on_open_floor(const Pose& start, double x_m, double y_m) {
  return front_case(free_grid(100, 80, 0.1), start, x_m, y_m);
}

/// Slow driving costs this robot little.
FrontCase on_two_legs() {
  FrontCase made = on_open_floor({2, 3, 0}, 6, 3);
  made.world.robot.power.standby_W = 1;
  made.mission.stations["back"] = {.x_m = 4, .y_m = 7, .heading_rad = 3.1};
  made.mission.legs.push_back({.to = "back", .payload = {4, 4}});
  return made;
}

std::vector<FrontCase> front_cases() {
  return {through_gaps(), on_two_legs(), on_open_floor({3, 3, 0}, 2.5, 5),
          on_open_floor({3, 3, -1.57}, 6, 6)};
}

const PlanOptions kFrontPlan{.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3, .baselines = false};

/// The front chose its ways for its cheapest drive: the least time was up to 3 % shorter on other ways.
TEST(Front, BeginsNoLaterThanThePlanOfLeastTimeAndEndsNoDearerThanThePlan) {
  for (const FrontCase& made : front_cases())
    for (const std::size_t points : {2u, 12u}) {
      const Front front = mission_front(made.mission, made.world, kFrontPlan, points, false).front;
      ASSERT_EQ(front.points.size(), points);
      MissionRequest fastest = made.mission;
      fastest.objective.minimize = Objective::Minimize::time;
      EXPECT_LE(front.points.front().duration_s,
                1.001 * plan_mission(fastest, made.world, kFrontPlan).duration_s);
      const Plan plan = plan_mission(made.mission, made.world, kFrontPlan);
      EXPECT_LE(front.points.back().energy_J, (1 + 2e-5) * plan.energy.total_J());
    }
}

/// The first point is the least time, whatever it costs.
TEST(Front, IsNoDearerThanAPlanWithItsTimeAsDeadline) {
  constexpr double kRounding = 1e-6;
  for (const FrontCase& made : front_cases()) {
    const Front front = mission_front(made.mission, made.world, kFrontPlan, 6, false).front;
    for (std::size_t k = 1; k < front.points.size(); ++k) {
      const FrontPoint& point = front.points[k];
      MissionRequest timed = made.mission;
      timed.objective.deadline_s = point.duration_s * (1 + kRounding);
      const Plan plan = plan_mission(timed, made.world, kFrontPlan);
      if (plan.status > SolveStatus::feasible) continue;  // the front is faster
      EXPECT_LE(point.energy_J, 1.001 * plan.energy.total_J()) << point.duration_s << " s";
    }
  }
}

/// A plan of a point's time on its ways takes its energy, and on the ways of the other points no less.
TEST(Front, IsTheLowestOfThePlansOnItsWays) {
  PlanOptions finer = kFrontPlan;
  finer.nodes = 120;
  for (const FrontCase& made : {through_gaps(), on_two_legs()}) {
    const auto [plans, front] = mission_front(made.mission, made.world, finer, 24, false);
    ASSERT_EQ(plans.size(), 4u);
    for (std::size_t k = 1; k < front.points.size(); ++k) {
      EXPECT_GT(front.points[k].duration_s, front.points[k - 1].duration_s);
      EXPECT_LT(front.points[k].energy_J, front.points[k - 1].energy_J);
    }
    for (std::size_t k = 1; k < front.points.size(); k += 8)
      for (std::size_t drive = 0; drive < plans.size(); ++drive) {
        MissionRequest timed = on_ways_of(plans[drive], made.mission);
        timed.objective.deadline_s = front.points[k].duration_s;
        const Plan plan = plan_mission(timed, made.world, finer);
        if (plan.status > SolveStatus::feasible) continue;
        const double energy_J = plan.energy.total_J();
        EXPECT_LE(front.points[k].energy_J, 1.001 * energy_J) << k << ", " << drive;
        if (drive != front.points[k].drive) continue;
        EXPECT_NEAR(front.points[k].energy_J, energy_J, 1e-3 * energy_J);
      }
  }
}

/// Ways are shaped without the jerk limit. Still no front is faster than the plan of least time, and a price
/// of time lowers no energy.
TEST(Front, UnderAJerkLimitIsNeitherFasterNorCheaperThanThePlans) {
  FrontCase made = on_open_floor({6.15, 3.25, 3.1416}, 4.775, 2.594);
  made.mission.stations["goal"].heading_rad = -0.345;
  made.mission.legs.front().dwell_s = 0;
  for (const double jerk_m_s3 : {0.3, 0.6}) {
    made.world.robot.limits->jerk_m_s3 = jerk_m_s3;
    const auto planned = [&](const Objective& objective) {
      MissionRequest mission = made.mission;
      mission.objective = objective;
      return plan_mission(mission, made.world, kFrontPlan);
    };
    const double fastest_s = planned({.minimize = Objective::Minimize::time}).duration_s;
    const double cheapest_J = planned({}).energy.total_J();
    EXPECT_GE(mission_front(made.mission, made.world, kFrontPlan, 4, false).front.points.front().duration_s,
              0.999 * fastest_s);
    for (const double value_W : {10.0, 100.0})
      EXPECT_GE(planned({.minimize = Objective::Minimize::energy_and_time, .time_value_W = value_W})
                    .energy.total_J(),
                0.997 * cheapest_J)
          << jerk_m_s3 << ", " << value_W;
  }
}

/// The straight line is the way of all plans.
TEST(Front, OnOneWayIsThatOfItsPlan) {
  const FrontCase made = on_open_floor({3, 3, 0}, 8, 3);
  const auto [plans, front] = mission_front(made.mission, made.world, kFrontPlan, 6, false);
  EXPECT_EQ(plans.size(), 1u);
  const Front alone = energy_time_front(planned_stretches(plans.front()), 6);
  ASSERT_EQ(front.points.size(), alone.points.size());
  for (std::size_t k = 0; k < alone.points.size(); ++k) {
    const FrontPoint point = sum_of(alone.points[k], rest_of(plans.front()));
    EXPECT_EQ(front.points[k].duration_s, point.duration_s);
    EXPECT_EQ(front.points[k].energy_J, point.energy_J);
  }
}

}  // namespace
}  // namespace joulepath
