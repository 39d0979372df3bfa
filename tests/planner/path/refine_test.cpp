#include "planner/path/shape/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/path/search/route.hpp"
#include "planner/path/shape/end_leads.hpp"
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
  const double begin_m = 4 - spline_tangent_m({{4, 0}, 0.7, 0.5}, std::numbers::pi / 2, true);
  EXPECT_NEAR(begin_m, 4 - 0.7 - std::hypot(0.7, 0.5), 1e-12);
  EXPECT_EQ(piece_point(path->pieces[0], begin_m - 1e-6).curvature_per_m, 0.0);
  EXPECT_GT(piece_point(path->pieces[0], begin_m + 1e-2).curvature_per_m, 0.0);
  EXPECT_FALSE(spline_path({0, 0}, {{{4, 0}, 2.1, 0.5}}, {4, 5}).has_value());  // no straight line left
}

/// Round a wall from the left to the right.
struct Passage {
  Passage() {
    for (int row = 0; row < 100; ++row)
      for (int column = 110; column < 126; ++column)
        map.occupancy_percent[static_cast<std::size_t>(row * 240 + column)] = 100;
  }
  SmoothPath blended(const RouteSpace& space) const {
    RouteRequest request;
    request.start = {2, 3, 0};
    request.goal_x_m = 10, request.goal_y_m = 3;
    return blend_corners(plan_route(space, request).polyline_m, space.checker().with_clearance(0.051), {});
  }

  OccupancyGrid map = free_grid(240, 200, 0.05);
};

TEST(Refine, LowersTheCostAndStaysFree) {
  const Passage passage;
  const RouteSpace space(passage.map, nullptr, {0.25, {}}, 0.05);
  const SmoothPath initial = passage.blended(space);
  const RefineResult refined = refine_path(space.checker(), initial, bending_cost);
  EXPECT_TRUE(refined.improved);
  EXPECT_LT(refined.cost, refined.cost_before);
  EXPECT_NEAR(bending_cost(refined.path), refined.cost, 1e-9);
  EXPECT_FALSE(space.checker().first_collision(refined.path).has_value());
  EXPECT_NEAR(refined.path.start().x_m, 2, 1e-12);
  EXPECT_NEAR(refined.path.end().x_m, 10, 1e-9);
  EXPECT_EQ(refine_path(space.checker(), initial, bending_cost).cost, refined.cost);
}

TEST(Refine, KeepsTheRequestedHeadings) {
  const Passage passage;
  const RouteSpace space(passage.map, nullptr, {0.25, {}}, 0.05);
  const auto led =
      blend_with_leads(passage.blended(space).polyline_m, Lead{0.0, 1.0}, Lead{-std::numbers::pi / 2, 1.0},
                       space.checker().with_clearance(0.051), {});
  ASSERT_TRUE(led.has_value());
  const RefineResult refined = refine_path(space.checker(), *led, bending_cost,
                                           {.keep_start_heading = true, .keep_goal_heading = true});
  ASSERT_TRUE(refined.improved);
  EXPECT_NEAR(wrapped_angle_rad(refined.path.start().heading_rad), 0, 1e-9);
  EXPECT_NEAR(wrapped_angle_rad(refined.path.end().heading_rad + std::numbers::pi / 2), 0, 1e-9);
  EXPECT_FALSE(space.checker().first_collision(refined.path).has_value());
}

TEST(Refine, NeverReturnsACheapPathThatCollides) {
  const Passage passage;
  const RouteSpace space(passage.map, nullptr, {0.25, {}}, 0.05);
  const auto through_walls = [](const Path& path) { return path.distance_m(); };  // the wall is the limit
  const RefineResult refined = refine_path(space.checker(), passage.blended(space), through_walls);
  EXPECT_FALSE(space.checker().first_collision(refined.path).has_value());
  EXPECT_LE(refined.cost, refined.cost_before);
}

TEST(Refine, ReturnsTheInitialPathWhereNothingIsBetter) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteSpace space(map, nullptr, {0.25, {}}, 0.05);
  const SmoothPath straight = blend_corners({{2, 3}, {8, 3}}, space.checker(), {});
  const RefineResult result = refine_path(space.checker(), straight, bending_cost);
  EXPECT_FALSE(result.improved);
  EXPECT_EQ(result.cost, result.cost_before);
  EXPECT_EQ(result.path.distance_m(), straight.path.distance_m());
}

}  // namespace
}  // namespace joulepath
