#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "planner/mission/mission.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using Points = std::vector<Point2>;
using PathAlong = std::function<WaypointPath(const Points&)>;

Plan rounded_plan(const Path& path) {
  MissionRequest mission{.name = "path", .start = {.pose = path.start()}};
  mission.legs = {{.path = PathRequest{.frame = PathRequest::Frame::map, .ready = path}}};
  return plan_mission(mission, {.robot = testing::nomad()},
                      {.solver = SolverChoice::fast, .nodes = 60, .baselines = false});
}

/// The same points, each moved by at most so much.
Points moved(const Points& points_m, double most_m, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  Points result = points_m;
  for (Point2& point : result)
    for (double& coordinate_m : point) coordinate_m += most_m * share(random) / std::sqrt(2.0);
  return result;
}

/// Points of which rounding changes neither the verdict nor the energy by more than 0.1 %.
void expect_rounding_is_nothing(const Points& points_m, const PathAlong& along, const char* name) {
  const WaypointPath exact = along(points_m);
  ASSERT_FALSE(exact.defect) << name << ": " << exact.defect->found;
  const Plan plan = rounded_plan(exact.path);
  ASSERT_LE(plan.status, SolveStatus::feasible) << name << ": " << plan.message;
  for (const double most_m : {1e-8, 1e-7, 1e-6})
    for (const unsigned seed : {1u, 2u}) {
      const WaypointPath rounded = along(moved(points_m, most_m, seed));
      ASSERT_FALSE(rounded.defect) << name << ": " << rounded.defect->found;
      const Plan other = rounded_plan(rounded.path);
      ASSERT_EQ(other.status, plan.status) << name << " " << most_m << ": " << other.message;
      EXPECT_NEAR(other.energy.total_J(), plan.energy.total_J(), 1e-3 * plan.energy.total_J())
          << name << " " << most_m;
    }
}

PathAlong with_radii(std::vector<double> radius_m) {
  return [=](const Points& points_m) { return lines_between(points_m, radius_m); };
}

TEST(RoundedPaths, WaypointsNearlyOnALineAreTheLine) {
  const Points line_m{{0, 0}, {0.6, 0}, {1, 0}, {2, 0}, {2.1, 0}};
  expect_rounding_is_nothing(line_m, with_radii({0, 0, 0, 0, 0}), "stops");
  expect_rounding_is_nothing(line_m, with_radii({0, 0.5, 0.5, 0.5, 0}), "arcs of half a meter");
  expect_rounding_is_nothing(line_m, with_radii({0, 0.01, 0, 2, 0}), "mixed");
}

TEST(RoundedPaths, CornersMoveByTheirRounding) {
  const Points corners_m{{0, 0}, {3, 0}, {3, 2}, {5, 2.3}, {5.5, 2.3}};
  expect_rounding_is_nothing(corners_m, with_radii({0, 0, 0, 0, 0}), "turns on the spot");
  expect_rounding_is_nothing(corners_m, with_radii({0, 0.5, 0.2, 0.05, 0}), "arcs");
  expect_rounding_is_nothing({{0, 0}, {1, 0}, {2, 4e-6}, {3, 0}}, with_radii({0, 0.5, 0.5, 0}),
                             "slight corners");
}

TEST(RoundedPaths, CurvesThroughWaypointsMoveByTheirRounding) {
  const PathAlong curve = [](const Points& points_m) { return curve_through(points_m); };
  expect_rounding_is_nothing({{0, 0}, {0.4, 0.1}, {2, 0.5}, {2.5, 1.5}, {1.5, 3}}, curve, "bends");
  expect_rounding_is_nothing({{0, 0}, {1, 0}, {3, 0}}, curve, "a line");
  expect_rounding_is_nothing({{0, 0}, {3, 0}, {0, 0}}, curve, "there and back");
  Points slow_m;
  for (int k = 0; k < 150; ++k) slow_m.push_back({0.02 * std::min(k, 60) + 0.02 * std::max(0, k - 90), 0.5});
  expect_rounding_is_nothing(slow_m, curve, "a log of a robot that stood");
}

TEST(RoundedPaths, ChainsOfCurvesMoveByTheirRounding) {
  const PathAlong chain = [](const Points& p) {
    std::vector<BezierPoints> curves_m;
    for (std::size_t i = 0; i + 3 < p.size(); i += 3)
      curves_m.push_back({p[i], p[i + 1], p[i + 2], p[i + 3]});
    const double heading_rad = std::atan2(p[1][1] - p[0][1], p[1][0] - p[0][0]);
    return WaypointPath{.path =
                            bezier_chain(curves_m, {p[0][0], p[0][1], heading_rad}, BezierFrame::map).path};
  };
  expect_rounding_is_nothing({{0, 0}, {0.5, 0}, {1, 0}, {1.5, 0}, {2, 0}, {2.5, 0}, {3, 1}}, chain, "smooth");
  expect_rounding_is_nothing({{0, 0}, {0.3, 0}, {0.7, 0}, {1, 0}, {1.3, 0}, {1.7, 0}, {2, 0}}, chain, "line");
}

TEST(RoundedPaths, PiecesShorterThanAMillimeterAreAnError) {
  for (const double short_m : {1e-9, 1e-6, 1e-5, 0.9e-3}) {
    const Points step_m{{0, 0}, {1, 0}, {1, short_m}, {2, short_m}};
    const WaypointPath lines = lines_between(step_m, {0, 0, 0, 0}), curve = curve_through(step_m);
    for (const WaypointPath* along : {&lines, &curve}) {
      ASSERT_TRUE(along->defect) << short_m;
      EXPECT_EQ(along->defect->waypoint, 2u);
      EXPECT_NE(along->defect->accepted.find("0.001 m"), std::string::npos) << along->defect->accepted;
    }
    const BezierPoints tiny{{{0, 0}, {short_m / 3, 0}, {2 * short_m / 3, 0}, {short_m, 0}}};
    EXPECT_EQ(bezier_defects(tiny, 0).at(0).kind, BezierFinding::Kind::no_length);
  }
}

}  // namespace
}  // namespace joulepath
