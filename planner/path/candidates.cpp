#include "planner/path/candidates.hpp"

#include <algorithm>

#include "planner/path/lattice.hpp"
#include "planner/path/polyline.hpp"
#include "planner/path/rate_table.hpp"

namespace joulepath {
namespace {

constexpr double kCorridor_m = 0.8;  // half width of what is made dear about an earlier route
constexpr double kNearEnd_m = 1.5;   // all routes share these neighborhoods
constexpr double kDearer = 1.0;      // added to the price of a metre each time
constexpr int kAttemptsPerRoute = 4;

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
  const DiscLineCheck free(floor, start, goal, FreeSpace::Cells::clear);
  const std::vector<Point2> islands = island_points(floor);
  RateTable table(request.cost, space.field().extent_m());
  const TravelCost cost = table.cost();
  Lattice lattice(floor);
  lattice.make_dear(results.front().polyline_m, kCorridor_m, kNearEnd_m, kDearer);
  for (int attempt = 0; attempt < kAttemptsPerRoute * count && static_cast<int>(results.size()) < count;
       ++attempt) {
    const std::vector<Point2> route = lattice.route(start, goal, free);
    if (route.empty()) break;
    lattice.make_dear(route, kCorridor_m, kNearEnd_m, kDearer);
    const std::vector<Point2> line = pull_taut(route, free, cost);
    const bool known = std::any_of(results.begin(), results.end(), [&](const RouteResult& other) {
      return same_homotopy_class(line, other.polyline_m, islands);
    });
    if (known || !line_is_free(line, free)) continue;
    if (polyline_cost(line, cost) > longest_ratio * results.front().polyline_cost) continue;
    RouteResult shaped = shape_route(space, request, line);
    shaped.searched_by = "lattice, away from earlier routes";
    if (shaped.found()) results.push_back(std::move(shaped));
  }
  std::stable_sort(results.begin(), results.end(), [](const RouteResult& a, const RouteResult& b) {
    return a.polyline_cost < b.polyline_cost;
  });
  return results;
}

}  // namespace joulepath
