#include "planner/path/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/path/route.hpp"
#include "tests/planner/path/curve_laws.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

/// Length plus a price of bending and of turns in place: like energy, but in closed form.
double bending_cost(const Path& path) {
  double sum = 2 * path.turned_rad();
  for (const PathPiece& piece : path.pieces) {
    if (is_turn(piece)) continue;
    const double length = piece_length(piece);
    const int steps = static_cast<int>(length / 0.02) + 1;
    for (int k = 0; k < steps; ++k) {
      const double curvature = piece_point(piece, length * (k + 0.5) / steps).curvature_per_m;
      sum += length / steps * (1 + 0.1 * curvature * curvature);
    }
  }
  return sum;
}

TEST(SplinePath, JoinsStraightLinesWithContinuousCurvature) {
  const auto path = spline_path({0, 0}, {{{4, 0}, 0.7, 0.5}, {{4, 3}, 0.4, 0.6}}, {8, 4});
  ASSERT_TRUE(path.has_value());
  const CurveBreach breach = curve_breach(path->pieces.at(0), 400);
  EXPECT_LT(breach.position_m, 1e-10);
  EXPECT_LT(breach.heading_rad, 1e-9);
  EXPECT_LT(breach.curvature_per_m, 1e-8);
  EXPECT_LT(breach.curvature_step_per_m, 1e-9);
  EXPECT_NEAR(path->end().x_m, 8, 1e-12);
  EXPECT_NEAR(path->end().y_m, 4, 1e-12);
  EXPECT_EQ(piece_point(path->pieces[0], 1.0).curvature_per_m, 0.0);
  EXPECT_FALSE(spline_path({0, 0}, {{{4, 0}, 2.1, 0.5}}, {4, 5}).has_value());  // no straight line left
}

TEST(Refine, LowersTheCostAndStaysFree) {
  OccupancyGrid map = free_grid(240, 200, 0.05);
  for (int row = 0; row < 100; ++row)
    for (int column = 110; column < 126; ++column)
      map.occupancy_percent[static_cast<std::size_t>(row * 240 + column)] = 100;
  const RouteSpace space(map, nullptr, {0.25, {}}, 0.05);
  RouteRequest request;
  request.start = {2, 3, 0};
  request.goal_x_m = 10, request.goal_y_m = 3, request.goal_heading_rad = -std::numbers::pi / 2;
  const RouteResult route = plan_route(space, request);
  ASSERT_TRUE(route.found());
  const RefineResult refined = refine_path(space.checker(), route.path, route.polyline_m, bending_cost);
  EXPECT_TRUE(refined.improved);
  EXPECT_LT(refined.cost, refined.cost_before);
  EXPECT_NEAR(bending_cost(refined.path), refined.cost, 1e-9);
  EXPECT_FALSE(space.checker().first_collision(refined.path).has_value());
  EXPECT_NEAR(refined.path.start().heading_rad, 0, 1e-12);
  EXPECT_NEAR(wrapped_angle_rad(refined.path.end().heading_rad + std::numbers::pi / 2), 0, 1e-9);
  EXPECT_NEAR(refined.path.end().x_m, 10, 1e-9);
  const RefineResult again = refine_path(space.checker(), route.path, route.polyline_m, bending_cost);
  EXPECT_EQ(again.cost, refined.cost);
}

TEST(Refine, ReturnsTheInitialPathWhereNothingIsBetter) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteSpace space(map, nullptr, {0.25, {}}, 0.05);
  RouteRequest request;
  request.start = {2, 3, 0};
  request.goal_x_m = 8, request.goal_y_m = 3;
  const RouteResult straight = plan_route(space, request);
  const RefineResult result = refine_path(space.checker(), straight.path, straight.polyline_m, bending_cost);
  EXPECT_FALSE(result.improved);
  EXPECT_EQ(result.cost, result.cost_before);
  EXPECT_EQ(result.path.distance_m(), straight.path.distance_m());
}

}  // namespace
}  // namespace joulepath
