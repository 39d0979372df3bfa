// Lower bounds of the length of ways on a floor.
#include "planner/bound/geodesic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "planner/path/search/route.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

constexpr double kAny_m = 1e3;

/// Around one corner the shortest way is a line, an arc, and a line.
TEST(ShortestWay, AroundACornerIsLineArcLine) {
  OccupancyGrid grid = free_grid(200, 200, 0.05);
  for (int row = 0; row < 100; ++row)
    for (int column = 95; column < 105; ++column) grid.occupancy_percent[grid.index_of({column, row})] = 100;
  const ObstacleField field(grid);
  const double r = 0.3, x0 = 3.0, x1 = 7.0, y = 4.0;  // the wall ends at y = 5, from x = 4.75 to 5.25
  const double dx = 4.75 - x0, dy = 5.0 - y, d = std::hypot(dx, dy), side = std::sqrt(d * d - r * r);
  const double turn = std::atan2(dy, dx) + std::asin(r / d);
  const double way_m = 2 * (side + r * turn) + 0.5;
  const Geodesic found = shortest_way(field, r, {x0, y}, {x1, y}, kAny_m);
  EXPECT_TRUE(found.around_corners);
  EXPECT_LE(found.length_m, way_m);
  EXPECT_GE(found.length_m, way_m - 0.03);
}

TEST(ShortestWay, OnAFreeFloorIsTheStraightLine) {
  const ObstacleField field(free_grid(100, 100, 0.05));
  const Geodesic found = shortest_way(field, 0.3, {1, 1}, {4, 3}, kAny_m);
  EXPECT_FALSE(found.around_corners);
  EXPECT_DOUBLE_EQ(found.length_m, std::hypot(3, 2));
}

/// Routes that the planner finds are never shorter, and on cluttered floors not much longer.
TEST(ShortestWay, IsBelowEveryRouteOfThePlanner) {
  std::mt19937 random(4);
  const auto draw = [&](int from, int to) {
    return from + static_cast<int>(random() % static_cast<unsigned>(to - from));
  };
  double sum_m = 0, bound_m = 0;
  for (int n = 0; n < 12; ++n) {
    OccupancyGrid grid = free_grid(160, 160, 0.05);
    for (int box = 0; box < 12; ++box) {
      const int left = draw(20, 130), bottom = draw(20, 130), width = draw(3, 20), height = draw(3, 20);
      for (int row = bottom; row < bottom + height; ++row)
        for (int column = left; column < left + width; ++column)
          grid.occupancy_percent[grid.index_of({column, row})] = 100;
    }
    const RouteSpace space(grid, nullptr, {.radius_m = 0.2}, 0.05);
    const RouteResult route = plan_route(
        space, {.start = {0.5, 0.5, 0}, .goal_x_m = 7.5, .goal_y_m = 7.5, .start_heading_free = true});
    if (!route.found()) continue;
    double route_m = 0;
    for (std::size_t k = 1; k < route.polyline_m.size(); ++k)
      route_m += distance_m(route.polyline_m[k - 1], route.polyline_m[k]);
    const Geodesic found = shortest_way(space.field(), 0.25, {0.5, 0.5}, {7.5, 7.5}, route_m + 0.01);
    EXPECT_LE(found.length_m, route_m + 1e-9) << n;
    EXPECT_GE(found.length_m, std::hypot(7, 7) - 1e-9) << n;
    sum_m += route_m, bound_m += found.length_m;
  }
  EXPECT_GT(sum_m, 0);
  EXPECT_GT(bound_m, 0.97 * sum_m);
}

}  // namespace
}  // namespace joulepath
