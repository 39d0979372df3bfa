// Compares search planners: taut length relative to the shortest one found, CPU time, failures.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "benchmarks/support/cpu_time.hpp"
#include "planner/path/search/lattice.hpp"
#include "planner/path/search/polyline.hpp"
#include "planner/path/search/route.hpp"
#include "planner/path/search/route_pool.hpp"
#include "tests/planner/path/grids.hpp"

namespace {

using namespace joulepath;

constexpr int kPairs = 24;
constexpr SearchPlanner kPlanners[] = {SearchPlanner::bit_star, SearchPlanner::abit_star,
                                       SearchPlanner::informed_rrt_star, SearchPlanner::rrt_star};

struct Row {
  std::vector<double> length_m{}, time_ms{};
};

using Pair = std::pair<Point2, Point2>;

std::vector<Pair> far_pairs(const RouteSpace& space) {
  const auto extent = space.field().extent_m();
  std::mt19937 random(17);
  std::uniform_real_distribution<double> x(extent.x_min_m, extent.x_max_m), y(extent.y_min_m, extent.y_max_m);
  std::vector<Pair> pairs;
  while (static_cast<int>(pairs.size()) < kPairs) {
    const Point2 a{x(random), y(random)}, b{x(random), y(random)};
    const FreeSpace& floor = space.any_heading();
    const bool free = space.field().disc_free(a[0], a[1], floor.radius_m()) &&
                      space.field().disc_free(b[0], b[1], floor.radius_m());
    if (!free || !floor.connected(a, b) || DiscLineCheck(floor, a, b, FreeSpace::Cells::clear)(a, b))
      continue;
    pairs.emplace_back(a, b);
  }
  return pairs;
}

/// Planner index -1: the lattice.
Row run(const RouteSpace& space, const std::vector<Pair>& pairs, int planner) {
  Row row;
  const FreeSpace& floor = space.any_heading();
  for (const auto& [a, b] : pairs) {
    const DiscLineCheck free(floor, a, b, FreeSpace::Cells::clear);
    const double begin_ms = cpu_ms();
    std::vector<Point2> line;
    if (planner < 0) {
      line = Lattice(floor).route(a, b, free);
    } else {
      SearchRequest request;
      request.start_m = a, request.goal_m = b, request.planner = kPlanners[planner];
      line = search_polyline(floor, request).polyline_m;
    }
    if (!line.empty()) line = pull_taut(line, free, {});
    row.time_ms.push_back(cpu_ms() - begin_ms);
    row.length_m.push_back(line.empty() ? std::numeric_limits<double>::infinity() : polyline_length_m(line));
  }
  return row;
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
}

void print_row(const char* name, const Row& row, const std::vector<double>& best_m) {
  std::vector<double> excess;
  int failed = 0;
  for (std::size_t i = 0; i < best_m.size(); ++i) {
    if (std::isfinite(row.length_m[i])) {
      excess.push_back(100 * (row.length_m[i] / best_m[i] - 1));
    } else {
      ++failed;
    }
  }
  if (excess.empty()) excess.push_back(std::nan(""));
  std::printf("| %s | %d | %.2f | %.2f | %.2f | %.0f | %.0f |\n", name, failed, quantile(excess, 0.5),
              quantile(excess, 0.95), quantile(excess, 1), quantile(row.time_ms, 0.5),
              quantile(row.time_ms, 1));
}

/// Pools of routes between the same ends, without and with OMPL.
void pool_section(const RouteSpace& space, const std::vector<Pair>& pairs) {
  const PoolOptions choices[] = {{}, {.searches = 1}, {.searches = 0}};
  const char* const names[] = {"lattice and BIT* twice", "lattice and BIT* once", "lattice"};
  std::vector<Row> rows(3);
  std::vector<double> best(pairs.size(), std::numeric_limits<double>::infinity());
  std::vector<double> classes(3, 0.0);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      RouteRequest request{.start = {pairs[i].first[0], pairs[i].first[1], 0}};
      request.goal_x_m = pairs[i].second[0], request.goal_y_m = pairs[i].second[1];
      const double begin_ms = cpu_ms();
      const std::vector<PooledRoute> pool = pool_routes(space, request, choices[c]);
      rows[c].time_ms.push_back(cpu_ms() - begin_ms);
      rows[c].length_m.push_back(pool.empty() ? std::numeric_limits<double>::infinity()
                                              : polyline_length_m(pool.front().polyline_m));
      best[i] = std::min(best[i], rows[c].length_m.back());
      classes[c] += static_cast<double>(pool.size());
    }
  for (std::size_t c = 0; c < 3; ++c) {
    char name[80];
    std::snprintf(name, sizeof name, "pool: %s (%.1f routes)", names[c],
                  classes[c] / static_cast<double>(pairs.size()));
    print_row(name, rows[c], best);
  }
}

void floor_section(const char* title, const OccupancyGrid& map, const OccupancyGrid* keepout) {
  const double begin_ms = cpu_ms();
  const RouteSpace space(map, keepout, {0.25, {}}, 0.05);
  const double space_ms = cpu_ms() - begin_ms;
  const std::vector<Pair> pairs = far_pairs(space);
  std::vector<Row> rows;
  for (int planner = -1; planner < 4; ++planner) rows.push_back(run(space, pairs, planner));
  std::vector<double> best_m(pairs.size(), std::numeric_limits<double>::infinity());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < best_m.size(); ++i) best_m[i] = std::min(best_m[i], row.length_m[i]);
  std::printf("\n## %s\n%d x %d cells of %.2f m; distance field and free space %.0f ms, once per map.\n\n",
              title, map.width, map.height, map.resolution_m, space_ms);
  std::printf(
      "| search | failed | excess length %%: median | p95 | worst | CPU ms: median | worst "
      "|\n|---|---|---|---|---|---|---|\n");
  print_row("lattice", rows[0], best_m);
  for (std::size_t i = 0; i < 4; ++i) print_row(search_planner_name(kPlanners[i]), rows[i + 1], best_m);
  Row route;
  for (const auto& [a, b] : pairs) {
    RouteRequest request;
    request.start = {a[0], a[1], 0};
    request.goal_x_m = b[0], request.goal_y_m = b[1];
    const double start_ms = cpu_ms();
    const RouteResult result = plan_route(space, request);
    route.time_ms.push_back(cpu_ms() - start_ms);
    route.length_m.push_back(result.found() ? result.path.distance_m()
                                            : std::numeric_limits<double>::infinity());
  }
  print_row("plan_route (BIT*, lattice, blends, check)", route, best_m);
  pool_section(space, pairs);
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("# Search planners\n\n%s\n\n", argc > 1 ? argv[1] : "");
  std::printf(
      "%d random pairs without line of sight per floor, disc of 0.25 m with 0.05 m clearance. Every polyline "
      "is pulled "
      "taut; excess is over the shortest that any search found for the pair. A blended path may be shorter "
      "than its "
      "polyline. CPU time of one thread, taut pulling included.\n",
      kPairs);
  floor_section("Generated warehouse, 60 x 40 m", warehouse_grid(1), nullptr);
  const auto map = nav2_warehouse(), keepout = nav2_warehouse_keepout(), depot = nav2_depot();
  if (map && keepout) floor_section("Nav2 warehouse with keep-out", *map, &*keepout);
  if (depot) floor_section("Nav2 depot", *depot, nullptr);
}
