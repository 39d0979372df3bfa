#include <gtest/gtest.h>

#include <cmath>

#include "planner/mission/mission.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

std::vector<Point2> winding_m(std::size_t count, double step_m) {
  std::vector<Point2> points_m;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = step_m * static_cast<double>(i);
    points_m.push_back({x, 3 * std::sin(x / 8)});
  }
  return points_m;
}

Plan plan_along(Path path) {
  MissionRequest mission{.name = "long"};
  mission.start.pose = path.start();
  mission.legs.push_back({.path = PathRequest{.ready = std::move(path)}});
  return plan_mission(mission, {.robot = testing::nomad()},
                      {.solver = SolverChoice::fast, .accuracy = 1e-2, .baselines = false});
}

/// Curvature has a kink at each waypoint, so that no coarser grid than the waypoints' own exists.
TEST(LongPath, AThousandKinksOfCurvatureArePlanned) {
  WaypointPath along = curve_through(winding_m(1301, 0.05), 0);
  ASSERT_FALSE(along.defect);
  const Plan plan = plan_along(std::move(along.path));
  EXPECT_LE(plan.status, SolveStatus::feasible) << plan.message;
}

TEST(LongPath, AHundredThousandRecordedPointsArePlannedOnAGridOfTheirShape) {
  WaypointPath along = curve_through(winding_m(100000, 0.005));
  ASSERT_FALSE(along.defect);
  const Plan plan = plan_along(std::move(along.path));
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  ASSERT_EQ(plan.legs[0].stretches.size(), 1u);
  EXPECT_LT(plan.legs[0].stretches[0].profile.s.size(), 2000u);
}

}  // namespace
}  // namespace joulepath
