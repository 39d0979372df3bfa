#include "planner/path/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "planner/path/polyline.hpp"

namespace joulepath {
namespace {

constexpr double kCorridor_m = 0.8;  // half width of what is made dear about an earlier route
constexpr double kNearEnd_m = 1.5;   // all routes share these neighborhoods
constexpr float kDearer = 1.0F;      // added to a cell's price each time
constexpr int kAttemptsPerRoute = 4;

/// Adds to the price of the cells about a polyline, away from its ends.
void make_dear(std::vector<float>& price, const OccupancyGrid& grid, const std::vector<Point2>& line) {
  const int reach = static_cast<int>(kCorridor_m / grid.resolution_m);
  std::vector<std::uint8_t> raised(price.size(), 0);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length_m = std::hypot(line[i + 1][0] - line[i][0], line[i + 1][1] - line[i][1]);
    const int steps = static_cast<int>(length_m / (0.5 * kCorridor_m)) + 1;
    for (int k = 0; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const double x = line[i][0] + t * (line[i + 1][0] - line[i][0]),
                   y = line[i][1] + t * (line[i + 1][1] - line[i][1]);
      const bool near_end = std::hypot(x - line.front()[0], y - line.front()[1]) < kNearEnd_m ||
                            std::hypot(x - line.back()[0], y - line.back()[1]) < kNearEnd_m;
      if (near_end) continue;
      const auto center = grid.cell_of(x, y);
      for (int row = center.row - reach; row <= center.row + reach; ++row)
        for (int column = center.column - reach; column <= center.column + reach; ++column) {
          if (!grid.contains({column, row}) || std::hypot(column - center.column, row - center.row) > reach)
            continue;
          raised[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                 static_cast<std::size_t>(column)] = 1;
        }
    }
  }
  for (std::size_t i = 0; i < price.size(); ++i)
    if (raised[i] != 0) price[i] += kDearer;
}

bool line_is_free(const std::vector<Point2>& line, const DiscLineCheck& free) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (!free(line[i], line[i + 1])) return false;
  return true;
}

}  // namespace

std::vector<RouteResult> plan_candidates(const RouteSpace& space, const RouteRequest& request, int count,
                                         double longest_ratio) {
  std::vector<RouteResult> results{plan_route(space, request)};
  if (!results.front().found() || results.front().polyline_m.size() < 2) return results;
  const Point2 start{request.start.x_m, request.start.y_m}, goal{request.goal_x_m, request.goal_y_m};
  const FreeSpace& floor = space.any_heading();
  const FreeSpace::Cells cells = FreeSpace::Cells::clear;
  const DiscLineCheck free(floor, start, goal, cells);
  const std::vector<Point2> islands = island_points(floor);
  const OccupancyGrid& grid = space.field().map();
  std::vector<float> price(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height),
                           1.0F);
  make_dear(price, grid, results.front().polyline_m);
  for (int attempt = 0; attempt < kAttemptsPerRoute * count && static_cast<int>(results.size()) < count;
       ++attempt) {
    const std::vector<Point2> route = floor.cell_route(start, goal, cells, &price);
    if (route.empty()) break;
    make_dear(price, grid, route);
    const std::vector<Point2> line = pull_taut(route, free, request.cost);
    const bool known = std::any_of(results.begin(), results.end(), [&](const RouteResult& other) {
      return same_homotopy_class(line, other.polyline_m, islands);
    });
    if (known || !line_is_free(line, free)) continue;
    if (polyline_cost(line, request.cost) > longest_ratio * results.front().polyline_cost) continue;
    RouteResult shaped = shape_route(space, request, line);
    shaped.searched_by = "cells, away from earlier routes";
    if (shaped.found()) results.push_back(std::move(shaped));
  }
  std::stable_sort(results.begin(), results.end(), [](const RouteResult& a, const RouteResult& b) {
    return a.polyline_cost < b.polyline_cost;
  });
  return results;
}

}  // namespace joulepath
