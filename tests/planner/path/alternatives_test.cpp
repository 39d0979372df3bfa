#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "planner/path/search/graph_route.hpp"
#include "planner/path/search/homotopy.hpp"
#include "planner/path/search/polyline.hpp"
#include "planner/path/search/route_pool.hpp"
#include "planner/path/shape/blended_path.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;
const Footprint kRound{0.25, {}};

void fill(OccupancyGrid& grid, int column0, int row0, int column1, int row1) {
  for (int row = row0; row < row1; ++row)
    for (int column = column0; column < column1; ++column)
      grid.occupancy_percent[static_cast<std::size_t>(row * grid.width + column)] = 100;
}

RouteRequest route_across(double x0, double y0, double x1, double y1) {
  RouteRequest request;
  request.start = {x0, y0, 0};
  request.goal_x_m = x1, request.goal_y_m = y1;
  return request;
}

TEST(Homotopy, SidesOfAnIslandAreDifferentClasses) {
  OccupancyGrid map = free_grid(100, 100, 0.1);
  fill(map, 40, 40, 60, 60);
  fill(map, 0, 90, 30, 100);  // touches the rim: no island
  const ObstacleField field(map);
  const FreeSpace space(field, 0.3);
  const auto islands = island_points(space);
  ASSERT_EQ(islands.size(), 1u);
  const std::vector<Point2> above{{1, 5}, {5, 8}, {9, 5}}, below{{1, 5}, {5, 2}, {9, 5}},
      wavy{{1, 5}, {3, 8}, {6, 7}, {9, 5}};
  EXPECT_TRUE(same_homotopy_class(above, wavy, islands));
  EXPECT_FALSE(same_homotopy_class(above, below, islands));
}

TEST(RoutePool, PassesTheIslandOnBothSidesCheapestFirst) {
  OccupancyGrid map = free_grid(200, 100, 0.1);
  fill(map, 80, 35, 120, 60);  // its lower side is nearer
  const RouteSpace space(map, nullptr, kRound, 0.05);
  const auto routes = pool_routes(space, route_across(3, 4.5, 17, 4.5), {});
  ASSERT_EQ(routes.size(), 2u);
  EXPECT_LT(routes[0].cost, routes[1].cost);
  EXPECT_FALSE(same_homotopy_class(routes[0].polyline_m, routes[1].polyline_m, space.islands_m()));
}

/// Walls across the floor, each with two openings hardly wider than the robot.
OccupancyGrid slit_walls(unsigned seed) {
  OccupancyGrid map = free_grid(240, 160, 0.05);
  std::mt19937 random(seed);
  const auto cell = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); };
  for (int wall = 0; wall < 3; ++wall) {
    const int column = 50 + 60 * wall + cell(-8, 8), thick = cell(1, 20);
    const int low = cell(10, 60), high = cell(90, 135), wide = cell(15, 17);
    fill(map, column, 0, column + thick, low);
    fill(map, column, low + wide, column + thick, high);
    fill(map, column, high + wide, column + thick, 160);
  }
  return map;
}

// The judge goes from cell to cell, its corners pulled taut without a last check; a route keeps more room.
TEST(RoutePool, NoOpeningIsMissedThatACellFits) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const RouteSpace space(slit_walls(seed), nullptr, kRound, 0.05);
    const RouteRequest request = route_across(1, 1 + 0.15 * seed, 11, 7 - 0.15 * seed);
    const auto cells = FreeSpace::Cells::clear;
    const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
    const auto by_cells = space.any_heading().cell_route(start, goal, cells);
    ASSERT_FALSE(by_cells.empty()) << seed;
    const double judge_m = polyline_length_m(
        pull_taut(by_cells, DiscLineCheck(space.any_heading(), start, goal, cells), TravelCost{}));
    for (const PoolOptions& options : {PoolOptions{.classes = 1, .searches = 0}, PoolOptions{}}) {
      const auto routes = pool_routes(space, request, options);
      ASSERT_FALSE(routes.empty()) << seed;
      EXPECT_LT(polyline_length_m(routes.front().polyline_m), 1.01 * judge_m) << seed;
    }
  }
}

// The quick check of cells keeps away from walls by more than a cell.
TEST(RoutePool, ALineThatTouchesTheClearanceOfAWallIsTheRoute) {
  OccupancyGrid map = free_grid(200, 100, 0.1);
  fill(map, 0, 80, 200, 100);  // from y = 8 m
  const RouteSpace space(map, nullptr, kRound, 0.05);
  for (const double slack_m : {0.0, 0.001, 0.03})
    for (const double end_m : {4.0, 17.0}) {
      const double y_m = 7.7 - slack_m;
      const auto routes = pool_routes(space, route_across(3, y_m, end_m, y_m), {});
      ASSERT_EQ(routes.size(), 1u);
      EXPECT_EQ(routes[0].polyline_m, (std::vector<Point2>{{3, y_m}, {end_m, y_m}})) << slack_m;
    }
  fill(map, 100, 79, 101, 80);  // a cell in the way
  const RouteSpace bumpy(map, nullptr, kRound, 0.05);
  const auto around = pool_routes(bumpy, route_across(3, 7.6, 17, 7.65), {});
  ASSERT_FALSE(around.empty());
  EXPECT_GT(around[0].polyline_m.size(), 2u);
}

/// A place whose distance to the nearest obstacle is `need_m` to rounding, from a free one along a bearing.
Point2 touching(const ObstacleField& field, const Point2& from, double bearing_rad, double need_m) {
  double out_m = 0, in_m = 0;
  const auto at = [&](double s_m) -> Point2 {
    return {from[0] + s_m * std::cos(bearing_rad), from[1] + s_m * std::sin(bearing_rad)};
  };
  const auto has_room = [&](double s_m) { return field.distance_m(at(s_m)[0], at(s_m)[1]) >= need_m; };
  while (has_room(in_m)) out_m = in_m, in_m += 0.05;
  for (int i = 0; i < 60; ++i) (has_room(0.5 * (out_m + in_m)) ? out_m : in_m) = 0.5 * (out_m + in_m);
  return at(out_m);
}

// A line is looked at in steps: what it lacks between two of them must not be more than what it has to spare.
TEST(RoutePool, RoutesBetweenEndsThatTouchTheClearanceAreFree) {
  OccupancyGrid map = free_grid(160, 120, 0.05);
  fill(map, 78, 0, 82, 50);
  fill(map, 78, 68, 82, 120);
  fill(map, 30, 40, 60, 44);
  const RouteSpace space(map, nullptr, kRound, 0.05);
  int free = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const Point2 start = touching(space.field(), {1.5, 3.5}, 0.26 * trial, 0.3),
                 goal = touching(space.field(), {6, 2.5}, 1.7 * trial, 0.3);
    const auto routes = pool_routes(space, route_across(start[0], start[1], goal[0], goal[1]), {});
    ASSERT_FALSE(routes.empty()) << trial;
    const SmoothPath shaped =
        blend_corners(routes[0].polyline_m, space.checker(), {.kind = CornerPolicy::Kind::stop_turn_go});
    const auto collision = space.checker().first_collision(shaped.path);
    free += collision ? 0 : 1;
    EXPECT_FALSE(collision) << trial << ": " << routes[0].polyline_m.size() << " vertices, short by "
                            << collision->short_by_m << " m";
  }
  EXPECT_EQ(free, 24);
}

TEST(RoutePool, HoldsFreeRoutesOfDifferentClassesInAWarehouse) {
  const OccupancyGrid map = warehouse_grid(2);
  const RouteSpace space(map, nullptr, kRound, 0.05);
  const PoolOptions options{.dearest_ratio = 1.3};
  const auto routes = pool_routes(space, route_across(1.3, 1.3, 58, 37), options);
  EXPECT_GE(routes.size(), 3u);
  for (std::size_t i = 0; i < routes.size(); ++i) {
    EXPECT_LE(routes[i].cost, options.dearest_ratio * routes[0].cost);
    const RouteResult shaped = shape_route(space, route_across(1.3, 1.3, 58, 37), routes[i].polyline_m);
    EXPECT_TRUE(shaped.found());
    EXPECT_FALSE(space.checker().first_collision(shaped.path).has_value());
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(same_homotopy_class(routes[i].polyline_m, routes[j].polyline_m, space.islands_m()));
  }
}

TEST(RoutePool, TheCostOfCornersRanksRoutesAndIsNotCached) {
  OccupancyGrid map = free_grid(200, 100, 0.1);
  fill(map, 80, 35, 120, 60);
  const RouteSpace space(map, nullptr, kRound, 0.05);
  RouteRequest request = route_across(3, 4.5, 17, 4.5);
  const auto plain = pool_routes(space, request, {});
  request.cost.per_rad = 2.0;
  const auto priced = pool_routes(space, request, {});
  ASSERT_FALSE(priced.empty());
  EXPECT_NEAR(priced[0].cost, plain[0].cost + 2.0 * corner_angles_rad(plain[0].polyline_m), 1e-9);
  EXPECT_EQ(pool_routes(space, route_across(3, 4.5, 17, 4.5), {})[0].cost, plain[0].cost);
}

TEST(TravelCostSearch, GoesAroundADearPatch) {
  const OccupancyGrid map = free_grid(200, 100, 0.1);
  const RouteSpace space(map, nullptr, kRound, 0.05);
  RouteRequest request = route_across(3, 5, 17, 5);
  EXPECT_NEAR(plan_route(space, request).path.distance_m(), 14.0, 1e-9);
  request.cost.rate = [](double x, double y, double) {
    return x > 8 && x < 12 && y > 3 && y < 8 ? 4.0 : 1.0;
  };
  const RouteResult around = plan_route(space, request);
  ASSERT_TRUE(around.found());
  // Through the patch: 10 + 4 * 4 = 26. Around its lower corners (8, 3), (12, 3): 2 sqrt(25 + 4) + 4 = 14.77.
  EXPECT_LT(around.polyline_cost, 15.2);
  EXPECT_GE(around.polyline_cost, 2 * std::sqrt(29.0) + 4 - 0.02);
}

TEST(EndBlends, ReplaceTurnsInPlaceWhereThereIsRoom) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteSpace space(map, nullptr, kRound, 0.05);
  RouteRequest request = route_across(3, 3, 7, 7);
  request.start.heading_rad = pi / 2;
  request.goal_heading_rad = pi / 2;
  EXPECT_GT(plan_route(space, request).path.turned_rad(), 1.0);
  request.blend_start = request.blend_goal = true;
  const RouteResult bent = plan_route(space, request);
  ASSERT_TRUE(bent.found());
  EXPECT_EQ(bent.path.pieces.size(), 1u);
  EXPECT_NEAR(wrapped_angle_rad(bent.path.start().heading_rad - pi / 2), 0, 1e-9);
  EXPECT_NEAR(wrapped_angle_rad(bent.path.end().heading_rad - pi / 2), 0, 1e-9);
  EXPECT_NEAR(bent.path.end().x_m, 7, 1e-9);
  request.corners.kind = CornerPolicy::Kind::stop_turn_go;
  EXPECT_GT(plan_route(space, request).path.turned_rad(), 1.0);
}

RouteGraph ladder() {
  RouteGraph graph;
  graph.nodes = {{0, 1, 1}, {1, 9, 1}, {2, 9, 9}, {3, 1, 9}};
  graph.edges = {{0, 0, 1, {}, {}}, {1, 1, 2, {}, {}}, {2, 0, 3, {}, {}}, {3, 3, 2, {}, {5, 5}}};
  return graph;
}

TEST(GraphRoute, KeepsToDirectedEdgesAndAvoidsBlockedOnes) {
  OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteGraph graph = ladder();
  {
    const RouteSpace space(map, nullptr, kRound, 0.05);
    const RouteResult route = plan_graph_route(space, route_across(1, 1, 9, 9), graph);
    ASSERT_TRUE(route.found());
    EXPECT_NEAR(route.polyline_cost, 16.0, 1e-9);
    const RouteResult back = plan_graph_route(space, route_across(9, 9, 1, 1), graph);
    EXPECT_EQ(back.verdict.status, RouteStatus::no_connection);
  }
  fill(map, 90, 0, 110, 60);  // across edge 0
  const RouteSpace space(map, nullptr, kRound, 0.05);
  const RouteResult route = plan_graph_route(space, route_across(1, 1, 9, 9), graph);
  ASSERT_TRUE(route.found());
  EXPECT_NEAR(route.polyline_cost, 8 + 2 * std::sqrt(32.0), 1e-9);
  EXPECT_FALSE(space.checker().first_collision(route.path).has_value());
}

}  // namespace
}  // namespace joulepath
