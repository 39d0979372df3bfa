#include "planner/path/search/route.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

#include "planner/path/search/polyline.hpp"
#include "tests/planner/path/curve_laws.hpp"
#include "tests/planner/path/grids.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;
const Footprint kDisc{0.25, {}};

/// Distance from a point to the nearest blocked square within a window, cell by cell: no transform.
double scanned_distance_m(const OccupancyGrid& grid, bool unknown_blocks, double x_m, double y_m,
                          double within_m) {
  double best = within_m;
  const auto center = grid.cell_of(x_m, y_m);
  const int reach = static_cast<int>(within_m / grid.resolution_m) + 2;
  for (int row = center.row - reach; row <= center.row + reach; ++row)
    for (int column = center.column - reach; column <= center.column + reach; ++column) {
      const bool inside = grid.contains({column, row});
      if (!inside && !unknown_blocks) continue;
      const int percent = inside ? grid.at({column, row}) : 100;
      if (percent < 65 && !(unknown_blocks && percent == kUnknownCell)) continue;
      const auto c = grid.center_of({column, row});
      const double h = 0.5 * grid.resolution_m;
      best = std::min(
          best, std::hypot(std::max(0.0, std::abs(x_m - c[0]) - h), std::max(0.0, std::abs(y_m - c[1]) - h)));
    }
  return best;
}

void expect_drivable(const Path& path, const RouteRequest& request, const OccupancyGrid& map,
                     const OccupancyGrid* keepout, double need_m) {
  ASSERT_FALSE(path.pieces.empty());
  Pose here = request.start;
  for (const PathPiece& piece : path.pieces) {
    const Pose begin = piece_point(piece, 0).pose;
    EXPECT_NEAR(begin.x_m, here.x_m, 1e-9);
    EXPECT_NEAR(begin.y_m, here.y_m, 1e-9);
    EXPECT_NEAR(wrapped_angle_rad(begin.heading_rad - here.heading_rad), 0, 1e-8);
    const CurveBreach breach = is_turn(piece) ? CurveBreach{} : curve_breach(piece, 20);
    EXPECT_LT(breach.position_m, 1e-9);
    EXPECT_LT(breach.heading_rad, 1e-9);
    EXPECT_LT(breach.curvature_per_m, 1e-9);
    EXPECT_LT(breach.curvature_step_per_m, 1e-9);
    const double length = piece_length(piece);
    const int steps = static_cast<int>(length / 0.01) + 1;
    for (int k = 0; k <= steps; ++k) {
      const PathPoint p = piece_point(piece, length * k / steps);
      EXPECT_GE(scanned_distance_m(map, true, p.pose.x_m, p.pose.y_m, need_m + 0.01), need_m - 1e-5);
      if (keepout == nullptr) continue;
      EXPECT_GE(scanned_distance_m(*keepout, false, p.pose.x_m, p.pose.y_m, need_m + 0.01), need_m - 1e-5);
    }
    EXPECT_NEAR(piece_point(piece, 0).curvature_per_m, 0, 1e-9);  // pieces begin and end straight
    EXPECT_NEAR(piece_point(piece, length).curvature_per_m, 0, 1e-9);
    here = piece_point(piece, length).pose;
  }
  EXPECT_NEAR(here.x_m, request.goal_x_m, 1e-9);
  EXPECT_NEAR(here.y_m, request.goal_y_m, 1e-9);
  if (!request.goal_heading_rad) return;
  EXPECT_NEAR(wrapped_angle_rad(here.heading_rad - *request.goal_heading_rad), 0, 1e-8);
}

/// Plans between random places; every connected pair must give a drivable path.
void random_routes(const OccupancyGrid& map, const OccupancyGrid* keepout, int count, unsigned seed) {
  const double clearance_m = 0.05, need_m = kDisc.radius_m + clearance_m;
  const RouteSpace space(map, keepout, kDisc, clearance_m);
  const auto extent = space.field().extent_m();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(extent.x_min_m, extent.x_max_m), y(extent.y_min_m, extent.y_max_m),
      angle(-pi, pi);
  int found = 0, unconnected = 0, corners = 0, blended = 0;
  for (int tried = 0; tried < count;) {
    RouteRequest request;
    request.start = {x(random), y(random), angle(random)};
    request.goal_x_m = x(random), request.goal_y_m = y(random), request.goal_heading_rad = angle(random);
    request.seed = static_cast<std::uint64_t>(tried + 1);
    if (!space.field().disc_free(request.start.x_m, request.start.y_m, need_m) ||
        !space.field().disc_free(request.goal_x_m, request.goal_y_m, need_m))
      continue;
    ++tried;
    const RouteResult result = plan_route(space, request);
    if (result.verdict.status == RouteStatus::no_connection) {
      ++unconnected;
      continue;
    }
    ASSERT_TRUE(result.found()) << result.verdict.message;
    expect_drivable(result.path, request, map, keepout, need_m);
    for (const CornerReport& corner : result.corners) ++corners, blended += corner.radius_m > 0 ? 1 : 0;
    ++found;
  }
  EXPECT_GT(found, count / 2);
  EXPECT_GT(blended, corners * 8 / 10);
}

TEST(Route, HoldsItsClearanceOnTheNav2Warehouse) {
  const auto map = nav2_warehouse(), keepout = nav2_warehouse_keepout();
  ASSERT_TRUE(map && keepout);
  random_routes(*map, &*keepout, 120, 31);
}

TEST(Route, HoldsItsClearanceOnTheNav2Depot) {
  const auto map = nav2_depot();
  ASSERT_TRUE(map);
  random_routes(*map, nullptr, 80, 32);
}

RouteRequest across(double x0, double y0, double x1, double y1) {
  RouteRequest request;
  request.start = {x0, y0, 0};
  request.goal_x_m = x1, request.goal_y_m = y1;
  return request;
}

bool same_bytes(const RouteResult& a, const RouteResult& b) {
  if (a.polyline_m != b.polyline_m || a.path.pieces.size() != b.path.pieces.size()) return false;
  for (std::size_t i = 0; i < a.path.pieces.size(); ++i)
    if (piece_breakpoints(a.path.pieces[i]) != piece_breakpoints(b.path.pieces[i])) return false;
  return a.search_iterations == b.search_iterations;
}

TEST(Route, SameSeedSameBytesOnAnyNumberOfThreads) {
  const OccupancyGrid map = warehouse_grid(1, 30, 20);
  const RouteSpace space(map, nullptr, kDisc, 0.05);
  std::vector<RouteRequest> requests;
  for (int i = 0; i < 6; ++i) {
    requests.push_back(across(1.2, 1.2 + 0.1 * i, 28.5, 18.2));
    requests.back().seed = static_cast<std::uint64_t>(i + 1);
  }
  std::vector<RouteResult> alone, threaded(requests.size());
  for (const RouteRequest& request : requests) alone.push_back(plan_route(space, request));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < requests.size(); ++i)
    threads.emplace_back([&, i] { threaded[i] = plan_route(space, requests[i]); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < requests.size(); ++i) {
    ASSERT_TRUE(alone[i].found());
    EXPECT_GT(alone[i].search_iterations, 100u);
    EXPECT_TRUE(same_bytes(alone[i], threaded[i])) << "seed " << i + 1;
  }
}

TEST(Route, IsNoLongerThanTheGridsOwnWay) {
  const OccupancyGrid map = warehouse_grid(3);
  const RouteSpace space(map, nullptr, kDisc, 0.05);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> x(1, 59), y(1, 39);
  for (int k = 0; k < 10;) {
    const Point2 a{x(random), y(random)}, b{x(random), y(random)};
    const RouteResult result = plan_route(space, across(a[0], a[1], b[0], b[1]));
    if (!result.found()) continue;
    ++k;
    const double cells_m = polyline_length_m(space.any_heading().cell_route(a, b, FreeSpace::Cells::clear));
    EXPECT_LE(result.path.distance_m(), 1.005 * cells_m);
    EXPECT_GE(result.path.distance_m(), std::hypot(b[0] - a[0], b[1] - a[1]) - 1e-9);
  }
}

TEST(Route, FreeFloorIsOneStraightLineWithTurnsAtItsEnds) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteSpace space(map, nullptr, kDisc, 0.05);
  RouteRequest request = across(2, 2, 8, 2);
  request.start.heading_rad = pi / 2;
  request.goal_heading_rad = pi;
  const RouteResult result = plan_route(space, request);
  ASSERT_TRUE(result.found());
  ASSERT_EQ(result.path.pieces.size(), 3u);
  EXPECT_NEAR(std::get<TurnInPlace>(result.path.pieces[0]).angle_rad, -pi / 2, 1e-12);
  EXPECT_NEAR(piece_length(result.path.pieces[1]), 6.0, 1e-12);
  EXPECT_NEAR(piece_length(result.path.pieces[2]), pi, 1e-12);
  request.start_heading_free = true;
  request.goal_heading_rad.reset();
  EXPECT_EQ(plan_route(space, request).path.pieces.size(), 1u);
}

TEST(Route, CornerPolicyDecidesHowCornersAreDriven) {
  OccupancyGrid map = free_grid(200, 200, 0.05);
  for (int row = 0; row < 120; ++row)
    for (int column = 90; column < 110; ++column)
      map.occupancy_percent[static_cast<std::size_t>(row * 200 + column)] = 100;
  const RouteSpace space(map, nullptr, kDisc, 0.05);
  RouteRequest request = across(2, 1, 8, 1);
  request.start_heading_free = true;
  request.corners.kind = CornerPolicy::Kind::stop_turn_go;
  const RouteResult turning = plan_route(space, request);
  ASSERT_TRUE(turning.found());
  EXPECT_GT(turning.path.turned_rad(), 1.0);
  request.corners = {CornerPolicy::Kind::blend_radius, 0.3};
  const RouteResult blended = shape_route(space, request, turning.polyline_m);
  ASSERT_TRUE(blended.found());
  EXPECT_EQ(blended.path.pieces.size(), 1u);
  double tightest = 0;
  for (int k = 0; k <= 5000; ++k)
    tightest = std::max(
        tightest,
        std::abs(piece_point(blended.path.pieces[0], blended.path.distance_m() * k / 5000).curvature_per_m));
  EXPECT_NEAR(tightest, 1 / 0.3, 1e-6);
  request.corners = {CornerPolicy::Kind::largest_blend, 0};
  const RouteResult widest = shape_route(space, request, turning.polyline_m);
  EXPECT_GT(widest.corners.at(0).radius_m, 0.4);
}

TEST(Route, SaysWhyAndWhereThereIsNone) {
  OccupancyGrid map = free_grid(200, 100, 0.1);
  for (int row = 0; row < 100; ++row)
    map.occupancy_percent[static_cast<std::size_t>(row * 200 + 100)] = 100;  // x in [10, 10.1]
  const RouteSpace space(map, nullptr, kDisc, 0.05);
  const RouteResult cut = plan_route(space, across(5, 5, 15, 5));
  EXPECT_EQ(cut.verdict.status, RouteStatus::no_connection);
  ASSERT_TRUE(cut.verdict.nearest_reachable_m.has_value());
  EXPECT_NEAR((*cut.verdict.nearest_reachable_m)[0], 9.65, 0.06);
  EXPECT_NEAR((*cut.verdict.nearest_reachable_m)[1], 5.0, 0.11);
  EXPECT_TRUE(cut.path.pieces.empty());

  const RouteResult start = plan_route(space, across(9.9, 5, 5, 5));
  EXPECT_EQ(start.verdict.status, RouteStatus::start_blocked);
  EXPECT_NEAR(start.verdict.short_by_m, 0.2, 1e-9);
  const RouteResult goal = plan_route(space, across(5, 5, 5, 0.1));
  EXPECT_EQ(goal.verdict.status, RouteStatus::goal_blocked);
  EXPECT_NEAR(goal.verdict.short_by_m, 0.2, 1e-9);
  EXPECT_EQ(goal.verdict.y_m, 0.1);
  EXPECT_FALSE(goal.verdict.message.empty());
}

TEST(Route, ABlockedEndIsToldByItsDistanceToAPlaceWhereTheRobotFits) {
  const RouteSpace space(free_grid(200, 100, 0.1), nullptr, kDisc, 0.05);  // 20 m x 10 m, 0.3 m to its edge
  const auto distance_m = [&](const RouteRequest& request) {
    const RouteVerdict verdict = *blocked_ends(space, request);
    const auto near = verdict.nearest_reachable_m.value_or(Point2{kNoLimit, kNoLimit});
    return std::hypot(near[0] - verdict.x_m, near[1] - verdict.y_m);
  };
  EXPECT_NEAR(distance_m(across(5, 5, 5, 70)), 60.3, 0.05);
  EXPECT_NEAR(distance_m(across(5, -20, 5, 5)), 20.3, 0.05);
  RouteRequest facing = across(5, 5, 19.9, 5);
  facing.goal_heading_rad = 1.0;
  EXPECT_NEAR(distance_m(facing), 0.2, 0.05);
}

TEST(Route, KeepoutIsNeverCrossedAndIsNamed) {
  const OccupancyGrid map = free_grid(200, 100, 0.1);
  OccupancyGrid keepout = free_grid(200, 100, 0.1);
  for (int row = 0; row < 80; ++row)
    for (int column = 90; column < 110; ++column)
      keepout.occupancy_percent[static_cast<std::size_t>(row * 200 + column)] = 100;
  const RouteSpace space(map, &keepout, kDisc, 0.05);
  RouteRequest request = across(5, 2, 15, 2);
  const RouteResult around = plan_route(space, request);
  ASSERT_TRUE(around.found());
  expect_drivable(around.path, request, map, &keepout, 0.3);
  EXPECT_GT(around.path.distance_m(), 15.0);
  const RouteResult into = plan_route(space, across(5, 2, 10, 2));
  EXPECT_EQ(into.verdict.status, RouteStatus::goal_blocked);
  EXPECT_TRUE(into.verdict.keepout);
}

TEST(Route, LongRobotBendsAwayFromAWallThatItCannotTurnAt) {
  const OccupancyGrid map = free_grid(200, 200, 0.05);
  const RouteSpace space(map, nullptr, {0, {{-0.6, -0.3}, {0.6, -0.3}, {0.6, 0.3}, {-0.6, 0.3}}}, 0.05);
  RouteRequest request = across(2, 0.55, 8, 8);  // along a wall that its tail hits when it turns
  const RouteResult result = plan_route(space, request);
  ASSERT_TRUE(result.found()) << result.verdict.message;
  EXPECT_FALSE(is_turn(result.path.pieces.front()));
  EXPECT_FALSE(space.checker().first_collision(result.path).has_value());
}

TEST(Route, LongRobotIsToldWhereItCannotTurn) {
  OccupancyGrid map = free_grid(200, 20, 0.05);  // a corridor of 1 m
  const RouteSpace space(map, nullptr, {0, {{-0.6, -0.3}, {0.6, -0.3}, {0.6, 0.3}, {-0.6, 0.3}}}, 0.05);
  RouteRequest request = across(1, 0.5, 9, 0.5);
  EXPECT_TRUE(plan_route(space, request).found());
  request.goal_heading_rad = pi;
  const RouteResult result = plan_route(space, request);
  EXPECT_EQ(result.verdict.status, RouteStatus::no_room_to_turn);
  EXPECT_NEAR(result.verdict.x_m, 9.0, 1e-6);
  // Its corners are hypot(0.6, 0.3) from the axis, the walls 0.5 m: contact, by at most the missing
  // clearance.
  EXPECT_GT(result.verdict.short_by_m, 0.05);
  EXPECT_LT(result.verdict.short_by_m, std::hypot(0.6, 0.3) + 0.05 - 0.5 + 1e-3);
}

}  // namespace
}  // namespace joulepath
