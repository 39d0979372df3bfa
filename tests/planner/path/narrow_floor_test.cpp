// Floors that are built about a known drive: a way must be found, whatever search finds it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planner/path/search/outline_route.hpp"
#include "planner/path/search/polyline.hpp"
#include "planner/path/search/route_pool.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

constexpr double kClearance_m = 0.05, kFront_m = 0.45, kHalf_m = 0.18;
const Footprint kSlim{
    0, {{kFront_m, kHalf_m}, {-kFront_m, kHalf_m}, {-kFront_m, -kHalf_m}, {kFront_m, -kHalf_m}}};

/// Corners of a drive along the axes of a floor of 9 x 7 m.
std::vector<Point2> drive_along_axes(std::mt19937& random) {
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::vector<Point2> corners{{draw(1, 3), draw(1, 6)}};
  for (int k = 0; k < 4; ++k) {
    Point2 next = corners.back();
    const std::size_t axis = k % 2 == 0 ? 0 : 1;
    while (std::abs(next[axis] - corners.back()[axis]) < 1.5)
      next[axis] = axis == 0 ? draw(1, 8) : draw(1, 6);
    corners.push_back(next);
  }
  return corners;
}

double excess_m(double value_m, double from_m, double to_m) {
  return std::max({from_m - value_m, 0.0, value_m - to_m});
}

/// Distance from what the outline and its clearance sweep on the drive, turns at the corners included.
double distance_from_drive_m(const std::vector<Point2>& corners, const Point2& p) {
  double least_m = 1e9;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Point2 &a = corners[i], &b = corners[i + 1];
    const bool along_x = a[1] == b[1];
    const double ahead_m = along_x ? kFront_m : kHalf_m, aside_m = along_x ? kHalf_m : kFront_m;
    const double dx = excess_m(p[0], std::min(a[0], b[0]) - ahead_m, std::max(a[0], b[0]) + ahead_m),
                 dy = excess_m(p[1], std::min(a[1], b[1]) - aside_m, std::max(a[1], b[1]) + aside_m);
    least_m = std::min(least_m, std::hypot(dx, dy));
    if (i > 0) least_m = std::min(least_m, distance_m(a, p) - std::hypot(kFront_m, kHalf_m));
  }
  return least_m - kClearance_m;
}

/// Everything is blocked that the drive leaves free.
OccupancyGrid carved(const std::vector<Point2>& corners, double resolution_m, double spare_m) {
  OccupancyGrid map = free_grid(static_cast<int>(std::lround(9 / resolution_m)),
                                static_cast<int>(std::lround(7 / resolution_m)), resolution_m);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const Point2 p{(column + 0.5) * resolution_m, (row + 0.5) * resolution_m};
      if (distance_from_drive_m(corners, p) > spare_m + std::sqrt(0.5) * resolution_m)
        map.occupancy_percent[map.index_of({column, row})] = 100;
    }
  return map;
}

TEST(NarrowFloor, AnOutlineFindsADriveThatIsKnown) {
  std::mt19937 random(7);
  int found = 0;
  for (int k = 0; k < 24; ++k) {
    const std::vector<Point2> corners = drive_along_axes(random);
    OccupancyGrid map = carved(corners, k % 2 == 0 ? 0.05 : 0.1, 0.02);
    const double yaw_rad = k % 3 == 0 ? 0.4 : 0.0;
    map.origin = {1, -2, yaw_rad};
    const auto placed = [&](const Point2& p) -> Point2 {
      const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
      return {1 + c * p[0] - s * p[1], -2 + s * p[0] + c * p[1]};
    };
    std::vector<Point2> drive;
    for (const Point2& corner : corners) drive.push_back(placed(corner));
    const RouteSpace space(map, nullptr, kSlim, kClearance_m);
    RouteRequest request;
    request.start = {drive[0][0], drive[0][1],
                     std::atan2(drive[1][1] - drive[0][1], drive[1][0] - drive[0][0])};
    request.goal_x_m = drive.back()[0], request.goal_y_m = drive.back()[1];
    ASSERT_TRUE(outline_drives(space, request, drive)) << k;
    const RouteResult route = plan_route(space, request);
    if (!route.found()) continue;
    ++found;
    EXPECT_FALSE(space.checker().first_collision(route.path)) << k;
    EXPECT_LT(polyline_length_m(route.polyline_m), 1.01 * polyline_length_m(drive)) << k;
  }
  // The search keeps one place per cell and heading, so that it misses a few drives that hardly fit.
  EXPECT_GE(found, 20);
}

TEST(NarrowFloor, AnOutlineThatHasNoRoomToTurnIsRefused) {
  OccupancyGrid map = carved({{1, 2}, {6, 2}, {6, 5}}, 0.05, 0.0);
  for (int row = 0; row < map.height; ++row)  // a post in the corner, beside the lines
    for (int column = 0; column < map.width; ++column)
      if (distance_m({(column + 0.5) * 0.05, (row + 0.5) * 0.05}, {6.43, 2.43}) < 0.16)
        map.occupancy_percent[map.index_of({column, row})] = 100;
  const RouteSpace space(map, nullptr, kSlim, kClearance_m);
  RouteRequest request;
  request.start = {1, 2, 0};
  request.goal_x_m = 6, request.goal_y_m = 5;
  EXPECT_FALSE(outline_drives(space, request, {{1, 2}, {6, 2}, {6, 5}}));
  const RouteResult route = plan_route(space, request);
  EXPECT_EQ(route.verdict.status, RouteStatus::no_room_to_turn);
  EXPECT_GT(route.verdict.short_by_m, 0);
}

/// A corridor of some cells along x, with a corner.
OccupancyGrid corridor(double resolution_m, int cells_wide) {
  const int half = static_cast<int>(std::lround(2 / resolution_m)),
            length = static_cast<int>(std::lround(6 / resolution_m));
  OccupancyGrid map = free_grid(length, length, resolution_m);
  for (int row = 0; row < length; ++row)
    for (int column = 0; column < length; ++column) {
      const bool along_x = row >= half && row < half + cells_wide && column < half + cells_wide;
      const bool along_y = column >= half && column < half + cells_wide && row >= half;
      if (!along_x && !along_y) map.occupancy_percent[map.index_of({column, row})] = 100;
    }
  return map;
}

TEST(NarrowFloor, ADiscFindsACorridorHardlyWiderThanItself) {
  // Between its walls no center of a cell is free: coarse cells; then 13 mm of room in all.
  for (const auto& [resolution_m, cells, radius_m] :
       {std::tuple{0.2, 4, 0.32}, {0.1, 6, 0.24}, {0.05, 12, 0.2435}, {0.05, 13, 0.274}}) {
    const OccupancyGrid map = corridor(resolution_m, cells);
    const RouteSpace space(map, nullptr, {radius_m, {}}, kClearance_m);
    const double middle_m = 2 + 0.5 * cells * resolution_m;
    RouteRequest request;
    request.start = {0.5, middle_m, 0};
    request.goal_x_m = middle_m, request.goal_y_m = 5.5;
    const RouteResult route = plan_route(space, request);
    ASSERT_TRUE(route.found()) << resolution_m << " " << cells << ": " << route.verdict.message;
    EXPECT_FALSE(space.checker().first_collision(route.path));
    const RouteSpace wider(map, nullptr, {0.5 * cells * resolution_m - kClearance_m + 0.001, {}},
                           kClearance_m);
    EXPECT_FALSE(plan_route(wider, request).found()) << resolution_m << " " << cells;
  }
}

}  // namespace
}  // namespace joulepath
