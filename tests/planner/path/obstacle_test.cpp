#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "planner/path/floor/distance_transform.hpp"
#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/floor/free_space.hpp"
#include "planner/path/geometry/polygon_distance.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

/// Distance to the nearest blocked square by looking at every cell.
double brute_force_distance_m(const OccupancyGrid& grid, double x_m, double y_m) {
  double best =
      std::min({x_m, y_m, grid.width * grid.resolution_m - x_m, grid.height * grid.resolution_m - y_m});
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at({column, row}) == 0) continue;
      const auto c = grid.center_of({column, row});
      const double h = 0.5 * grid.resolution_m;
      best = std::min(
          best, std::hypot(std::max(0.0, std::abs(x_m - c[0]) - h), std::max(0.0, std::abs(y_m - c[1]) - h)));
    }
  return std::max(best, 0.0);
}

TEST(DistanceTransform, EqualsBruteForce) {
  const auto gap2 = [](int cells) { return std::pow(std::max(0.0, std::abs(cells) - 0.5), 2); };
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    const int width = 1 + static_cast<int>(random() % 40), height = 1 + static_cast<int>(random() % 40);
    std::vector<std::uint8_t> marked(static_cast<std::size_t>(width * height));
    for (auto& cell : marked) cell = random() % 23 == 0;
    const auto distance = squared_distance_transform(marked, width, height);
    for (int i = 0; i < width * height; ++i) {
      double best = kNoneMarked;
      for (int j = 0; j < width * height; ++j)
        if (marked[static_cast<std::size_t>(j)] != 0)
          best = std::min(best, gap2(i % width - j % width) + gap2(i / width - j / width));
      EXPECT_FLOAT_EQ(distance[static_cast<std::size_t>(i)], static_cast<float>(best));
    }
  }
}

TEST(ObstacleField, DistanceIsExactAndWithinItsBounds) {
  const OccupancyGrid grid = random_grid(60, 40, 0.05, 0.02, 5);
  const ObstacleField field(grid);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(0, 3), y(0, 2);
  for (int i = 0; i < 2000; ++i) {
    const double px = x(random), py = y(random), truth = brute_force_distance_m(grid, px, py);
    EXPECT_NEAR(field.distance_m(px, py), truth, 1e-12);
    const auto bounds = field.distance_bounds_m(px, py);
    EXPECT_LE(bounds.lower_m, truth + 1e-6);
    EXPECT_GE(bounds.upper_m, truth - 1e-6);
    for (const double radius : {0.03, 0.1, 0.2}) EXPECT_EQ(field.disc_free(px, py, radius), truth >= radius);
  }
}

TEST(ObstacleField, TurnedGridsSeeTheSameFloor) {
  OccupancyGrid grid = random_grid(50, 50, 0.1, 0.03, 9);
  const ObstacleField straight(grid);
  grid.origin = {4.0, -3.0, 0.7};
  const ObstacleField turned(grid);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 5);
  for (int i = 0; i < 500; ++i) {
    const double px = u(random), py = u(random), c = std::cos(0.7), s = std::sin(0.7);
    EXPECT_NEAR(turned.distance_m(4 + c * px - s * py, -3 + s * px + c * py), straight.distance_m(px, py),
                1e-9);
  }
}

TEST(ObstacleField, KeepoutBlocksAndItsOutsideDoesNot) {
  const OccupancyGrid map = free_grid(100, 100, 0.1);
  OccupancyGrid keepout = free_grid(20, 20, 0.05);  // its own resolution and place
  keepout.origin = {4, 4, 0};
  for (auto& cell : keepout.occupancy_percent) cell = 100;
  const ObstacleField field(map, &keepout);
  EXPECT_NEAR(field.distance_m(3.0, 4.5), 1.0, 1e-12);
  EXPECT_EQ(field.nearest(3.0, 4.5).layer, ObstacleField::Layer::keepout);
  EXPECT_EQ(field.distance_m(4.5, 4.5), 0.0);
  EXPECT_NEAR(field.distance_m(8.5, 8.0), 1.5, 1e-12);  // the map's rim
}

TEST(ObstacleField, UnknownAndOutsideAreObstacles) {
  OccupancyGrid map = free_grid(40, 40, 0.1);
  map.occupancy_percent[20 * 40 + 20] = kUnknownCell;
  const ObstacleField field(map);
  EXPECT_EQ(field.distance_m(2.05, 2.05), 0.0);
  EXPECT_EQ(field.nearest(2.05, 2.45).layer, ObstacleField::Layer::unknown);
  EXPECT_EQ(field.distance_m(-1.0, 2.0), 0.0);
  EXPECT_EQ(field.nearest(-1.0, 2.0).layer, ObstacleField::Layer::edge);
  EXPECT_NEAR(field.distance_m(0.3, 2.0), 0.3, 1e-12);
}

/// A walk along a line leaps over clear cells: it must stop at every other cell that points of the line are
/// in.
TEST(FreeSpace, ALineLeapsOverNoCellThatIsNotClear) {
  OccupancyGrid grid = random_grid(300, 200, 0.05, 0.001, 8);
  grid.origin = {1.0, -2.0, 0.4};
  const ObstacleField field(grid);
  const FreeSpace space(field, 0.2);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u_m(-0.5, 15.5), v_m(-0.5, 10.5);
  const double c = std::cos(0.4), s = std::sin(0.4);
  const auto place = [&]() -> Point2 {
    const double u = u_m(random), v = v_m(random);
    return {1.0 + c * u - s * v, -2.0 + s * u + c * v};
  };
  int lines_with_none = 0;
  for (int i = 0; i < 400; ++i) {
    const Point2 a = place(), b = i % 2 == 0 ? place() : Point2{a[0] + 0.3 * c, a[1] + 0.3 * s};
    std::set<std::pair<int, int>> visited;
    EXPECT_TRUE(space.for_unclear_cells_on_line(a, b, [&](OccupancyGrid::CellIndex cell) {
      visited.emplace(cell.column, cell.row);
      return true;
    }));
    lines_with_none += visited.empty();
    for (int k = 0; k <= 5000; ++k) {
      const double share = k / 5000.0;
      const Point2 p{a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
      if (space.clear(p[0], p[1])) continue;
      const OccupancyGrid::CellIndex cell = grid.cell_of(p[0], p[1]);
      ASSERT_TRUE(visited.contains({cell.column, cell.row})) << i << ", " << share;
    }
  }
  EXPECT_GT(lines_with_none, 50);
}

TEST(PolygonDistance, SquareAgainstSquare) {
  const std::vector<Point2> unit{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  EXPECT_NEAR(square_distance_m(unit, {3, 0}, 0.5), 1.5, 1e-15);
  EXPECT_NEAR(square_distance_m(unit, {2, 2}, 0.5), std::hypot(0.5, 0.5), 1e-15);
  EXPECT_LE(square_distance_m(unit, {0, 0}, 0.1), 0.0);
  EXPECT_LE(square_distance_m(unit, {0, 0}, 5.0), 0.0);     // the square holds the polygon
  EXPECT_LT(square_distance_m(unit, {1.2, 0}, 0.5), 0.0);   // edges cross, its center is outside
  EXPECT_LT(square_distance_m(unit, {1.49, 0}, 0.5), 0.0);  // it reaches in by 1 cm
  EXPECT_EQ(square_distance_m(unit, {1.5, 0}, 0.5), 0.0);   // they touch
  const std::vector<Point2> strip{{-5, -0.1}, {5, -0.1}, {5, 0.1}, {-5, 0.1}};
  EXPECT_LT(square_distance_m(strip, {0, 0.5}, 0.5), 0.0);  // across it, all corners outside
}

TEST(FootprintChecker, DiscAndManyCorneredPolygonAgree) {
  const OccupancyGrid grid = random_grid(80, 80, 0.05, 0.004, 21);
  const ObstacleField field(grid);
  Footprint disc{0.3, {}}, polygon{};
  for (int i = 0; i < 720; ++i)
    polygon.polygon_m.push_back({0.3 * std::cos(pi * i / 360), 0.3 * std::sin(pi * i / 360)});
  const FootprintChecker round(field, disc, 0.05), cornered(field, polygon, 0.05);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(0.2, 3.8);
  int near = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose pose{u(random), u(random), u(random)};
    const double slack = round.slack_m(pose);
    if (std::abs(slack) > 0.05 || slack < -0.2) continue;
    EXPECT_NEAR(cornered.slack_m(pose), slack, 1e-5);
    ++near;
  }
  EXPECT_GT(near, 50);
}

TEST(FootprintChecker, LongRobotPassesAlongButCannotTurn) {
  OccupancyGrid grid = free_grid(100, 20, 0.05);  // a corridor of 1 m, walls are the map's rim
  const ObstacleField field(grid);
  Footprint robot{};
  robot.polygon_m = {{-0.6, -0.3}, {0.6, -0.3}, {0.6, 0.3}, {-0.6, 0.3}};
  const FootprintChecker checker(field, robot, 0.05);
  EXPECT_FALSE(checker.first_collision(straight_piece({1, 0.5, 0}, 3.0)).has_value());
  const auto turn = checker.first_collision(PathPiece{TurnInPlace{{2.5, 0.5, 0}, pi / 2}});
  ASSERT_TRUE(turn.has_value());
  // Its corner at (0.6, 0.3) reaches the clearance line 0.45 m from the axis at this angle:
  EXPECT_NEAR(turn->s, std::asin(0.45 / std::hypot(0.6, 0.3)) - std::atan2(0.3, 0.6), 5e-3);
}

// Cells inside of an obstacle are left out: its rim decides, but for an outline that lies inside, all of it.
TEST(FootprintChecker, ThePolygonsSlackIsThatOfEveryBlockedCell) {
  OccupancyGrid grid = free_grid(60, 60, 0.1);
  std::mt19937 random(12);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<>(from, to)(random);
  };
  for (int block = 0; block < 8; ++block) {
    const int column0 = static_cast<int>(draw(0, 50)), row0 = static_cast<int>(draw(0, 50));
    for (int row = row0; row < std::min(60, row0 + 12); ++row)
      for (int column = column0; column < std::min(60, column0 + 12); ++column)
        grid.occupancy_percent[static_cast<std::size_t>(row * 60 + column)] = 100;
  }
  const ObstacleField field(grid);
  const FootprintChecker checker(field, {0, {{-0.2, -0.15}, {0.4, -0.15}, {0.3, 0.2}, {-0.2, 0.15}}}, 0.05);
  int near = 0, within = 0;
  for (int i = 0; i < 4000; ++i) {
    const Pose pose{draw(0.1, 5.9), draw(0.1, 5.9), draw(-pi, pi)};
    const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
    std::vector<Point2> outline;
    for (const auto& p : std::vector<Point2>{{-0.2, -0.15}, {0.4, -0.15}, {0.3, 0.2}, {-0.2, 0.15}})
      outline.push_back({pose.x_m + c * p[0] - s * p[1], pose.y_m + s * p[0] + c * p[1]});
    double least_m = 1;
    for (int row = -8; row < 68; ++row)
      for (int column = -8; column < 68; ++column)
        if (!grid.contains({column, row}) || grid.at({column, row}) != 0)
          least_m =
              std::min(least_m, square_distance_m(outline, {0.1 * (column + 0.5), 0.1 * (row + 0.5)}, 0.05));
    const double slack_m = checker.near_slack_m(pose);
    if (least_m >= 0)
      EXPECT_NEAR(slack_m, std::min(least_m - 0.05, 0.1), 1e-9);
    else
      EXPECT_LT(slack_m, -0.05) << least_m;
    near += least_m >= 0 && least_m < 0.15 ? 1 : 0;
    within += least_m < -0.1 ? 1 : 0;
  }
  EXPECT_GT(near, 200);
  EXPECT_GT(within, 200);
}

TEST(FootprintChecker, SaysWhereAndByHowMuch) {
  OccupancyGrid grid = free_grid(100, 100, 0.1);
  for (int row = 0; row < 100; ++row) grid.occupancy_percent[static_cast<std::size_t>(row * 100 + 60)] = 100;
  const ObstacleField field(grid);
  const FootprintChecker checker(field, {0.25, {}}, 0.05);
  const auto hit = checker.first_collision(straight_piece({2, 5, 0}, 6.0));
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->s, 6.0 - 0.3 - 2.0, 0.003);
  EXPECT_NEAR(hit->obstacle.x_m, 6.0, 1e-9);
  EXPECT_LT(hit->short_by_m, 0.003);
  EXPECT_NEAR(checker.pose_collision({5.9, 5, 0})->short_by_m, 0.2, 1e-9);
}

TEST(FootprintChecker, NoRobotIsFreeOutsideOfTheMapHoweverFar) {
  const OccupancyGrid grid = free_grid(40, 40, 0.1);
  const ObstacleField field(grid);
  const FootprintChecker disc(field, {0.3, {}}, 0.0),
      box(field, {0, {{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}}}, 0.0);
  for (const double out_m : {0.1, 0.5, 2.0, 7.0, 300.0, 1e6})
    for (const Pose& pose :
         {Pose{4 + out_m, 2, 0.4}, Pose{-out_m, 2, 0.4}, Pose{2, 4 + out_m, 0.4}, Pose{-out_m, -out_m, 0.4}})
      for (const FootprintChecker* checker : {&disc, &box}) {
        const auto collision = checker->pose_collision(pose);
        ASSERT_TRUE(collision) << pose.x_m << ", " << pose.y_m;
        EXPECT_EQ(collision->obstacle.layer, ObstacleField::Layer::edge);
      }
}

TEST(FootprintChecker, ACellThatReachesInByLessThanHalfIsACollisionWithoutAnyClearance) {
  OccupancyGrid grid = free_grid(100, 100, 0.1);
  grid.occupancy_percent[50 * 100 + 60] = 100;  // from x = 6.0, y from 5.0 to 5.1
  const ObstacleField field(grid);
  const FootprintChecker box(field, {0, {{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}}}, 0.0);
  EXPECT_FALSE(box.pose_collision({5.6 - 1e-6, 5, 0}));
  ASSERT_TRUE(box.pose_collision({5.61, 5, 0}));
  EXPECT_NEAR(box.pose_collision({5.61, 5, 0})->short_by_m, 0.01, 1e-9);
}

TEST(FootprintChecker, ACoarseKeepoutIsSeenByPolygonsUpToItsBorder) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  OccupancyGrid keepout = free_grid(5, 5, 2.0);
  keepout.occupancy_percent[2 * 5 + 2] = 100;  // x and y from 4 to 6 m
  const ObstacleField field(map, &keepout);
  const FootprintChecker box(field, {0, {{-0.4, -0.3}, {0.4, -0.3}, {0.4, 0.3}, {-0.4, 0.3}}}, 0.0);
  EXPECT_TRUE(box.pose_collision({3.61, 5, 0}));
  EXPECT_FALSE(box.pose_collision({3.59, 5, 0}));
}

TEST(FootprintChecker, ACollisionNamesTheObstacleThatItMeets) {
  // The nearest obstacle to the axle is beside the robot; the collision is with the pallet at its front.
  OccupancyGrid map = free_grid(100, 100, 0.1), keepout = free_grid(100, 100, 0.1);
  map.occupancy_percent[60 * 100 + 50] = 100;      // (5.0..5.1, 6.0..6.1)
  keepout.occupancy_percent[50 * 100 + 68] = 100;  // (6.8..6.9, 5.0..5.1)
  const ObstacleField field(map, &keepout);
  const FootprintChecker truck(field, {0, {{-0.5, -0.3}, {2.0, -0.3}, {2.0, 0.3}, {-0.5, 0.3}}}, 0.0);
  const auto collision = truck.pose_collision({5.0, 5.05, 0});
  ASSERT_TRUE(collision);
  EXPECT_EQ(collision->obstacle.layer, ObstacleField::Layer::keepout);
  EXPECT_NEAR(collision->obstacle.x_m, 6.8, 0.11);
  EXPECT_NEAR(collision->obstacle.y_m, 5.05, 0.06);
  EXPECT_NEAR(collision->short_by_m, 0.2, 0.051) << "from the nose at x = 7 to the near side at 6.8";
}

}  // namespace
}  // namespace joulepath
