#include "planner/path/search/route_pool.hpp"

#include <algorithm>
#include <cmath>

#include "planner/path/search/homotopy.hpp"
#include "planner/path/search/lattice.hpp"
#include "planner/path/search/outline_route.hpp"
#include "planner/path/search/polyline.hpp"
#include "planner/path/search/route_cache.hpp"
#include "planner/path/search/tabulated_cost.hpp"

namespace joulepath {
namespace {

constexpr double kCorridor_m = 0.8;  // half width of the penalty zone around an earlier route
constexpr double kNearEnd_m = 1.5;   // within this distance of the ends there is no penalty
constexpr double kDearer = 1.0;      // increase of the price of a metre per earlier route
constexpr double kWideWithin_m = 2.5;
constexpr double kWideExtra_m = 0.6;
constexpr int kAttemptsPerClass = 2;
constexpr unsigned kPatience = 1000;  // of a search for length, which the lattice does as well
constexpr std::uint64_t kSeedStride = 7919;

/// The routes found so far between the ends of one request.
class Pool {
 public:
  Pool(const RouteSpace& space, const RouteRequest& request)
      : space_(space),
        request_(request),
        start_{request.start.x_m, request.start.y_m},
        goal_{request.goal_x_m, request.goal_y_m},
        floor_(space.floor_between(start_, goal_)),
        turns_everywhere_(space.checker().is_disc() || &floor_ == &space.any_heading()),
        table_(request.cost, space.field().extent_m()),
        cost_(table_.cost()),
        lattice_(floor_) {}

  bool straight() {
    if (request_.cost.rate || !DiscLineCheck(floor_, start_, goal_, FreeSpace::Cells::free)(start_, goal_))
      return false;
    add({start_, goal_}, "line of sight");
    return routes_.front().outline_fits;
  }
  /// Searches for the outline itself where it cannot turn everywhere.
  void search_outline() {
    if (turns_everywhere_) return;
    std::vector<Point2> line = outline_route(space_, floor_, request_);
    if (line.empty()) line = outline_route(space_, space_.narrow(), request_);
    if (!line.empty()) add(line, "outline");
  }
  /// Searches cell by cell, so that no passage is missed, and the lattice; determines the cells that a way
  /// may use.
  void search_cells() {
    std::vector<Point2> line = floor_.cell_route(start_, goal_, cells_);
    if (line.empty()) line = floor_.cell_route(start_, goal_, cells_ = FreeSpace::Cells::free);
    add_taut(line, "cells");
    add_taut(lattice_.route(start_, goal_, DiscLineCheck(floor_, start_, goal_, cells_)), "lattice");
  }
  void search(std::uint64_t seed) {
    SearchRequest request{start_, goal_, cells_, cost_, seed};
    if (!cost_.rate) request.patience = kPatience;
    const SearchResult found = search_polyline(floor_, request);
    iterations_ += found.iterations;
    add_taut(found.polyline_m, "bit_star");
  }
  void search_away(int classes) {
    const DiscLineCheck free(floor_, start_, goal_, cells_);
    for (const PooledRoute& route : routes_) avoid(route.polyline_m);
    for (int attempt = 0; attempt < kAttemptsPerClass * classes; ++attempt) {
      const std::vector<Point2> line = lattice_.route(start_, goal_, free);
      if (line.empty()) return;
      avoid(line);
      add_taut(line, "lattice, away from earlier routes");
    }
  }
  std::vector<PooledRoute> routes() && {
    for (PooledRoute& route : tight_)
      if (same_class(route) == routes_.end()) routes_.push_back(std::move(route));
    for (PooledRoute& route : routes_) route.search_iterations = iterations_;
    return std::move(routes_);
  }

 private:
  void avoid(const std::vector<Point2>& line) { lattice_.make_dear(line, kCorridor_m, kNearEnd_m, kDearer); }

  void add_taut(const std::vector<Point2>& found, const std::string& source) {
    if (found.empty()) return;
    for (const double spare_m : {FreeSpace::kSpare_m, FreeSpace::kLeastSpare_m}) {
      const DiscLineCheck quick(floor_, start_, goal_, cells_, spare_m),
          exact(floor_, start_, goal_, FreeSpace::Cells::free, spare_m);
      const std::vector<Point2> line = pull_taut(found, quick, cost_);
      const auto passes = [&line](const DiscLineCheck& free) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
          if (!free(line[i], line[i + 1])) return false;
        return true;
      };
      if (spare_m == FreeSpace::kSpare_m && passes(quick)) return add(line, source);
      if (passes(exact)) return tight_.push_back(pooled(line, source));
    }
  }

  bool fits(const std::vector<Point2>& line) const {
    return turns_everywhere_ || outline_drives(space_, request_, line);
  }

  std::vector<PooledRoute>::iterator same_class(const PooledRoute& route) {
    return std::find_if(routes_.begin(), routes_.end(), [&](const PooledRoute& other) {
      return route.outline_fits == other.outline_fits &&
             same_homotopy_class(route.polyline_m, other.polyline_m, space_.islands_m());
    });
  }

  PooledRoute pooled(const std::vector<Point2>& line, const std::string& source) const {
    return {.polyline_m = line,
            .cost = polyline_cost(line, cost_),
            .searched_by = source,
            .outline_fits = fits(line)};
  }

  void add(const std::vector<Point2>& line, const std::string& source) {
    PooledRoute route = pooled(line, source);
    route.wide_m =
        merged_corners(line, DiscLineCheck(floor_, start_, goal_, cells_), kWideWithin_m, kWideExtra_m);
    if (route.wide_m.size() == line.size()) route.wide_m.clear();
    const auto same = same_class(route);
    if (same == routes_.end())
      routes_.push_back(std::move(route));
    else if (route.cost < same->cost)
      *same = std::move(route);
  }

  const RouteSpace& space_;
  const RouteRequest& request_;
  Point2 start_, goal_;
  const FreeSpace& floor_;
  bool turns_everywhere_;  ///< the outline, on a way between the ends
  FreeSpace::Cells cells_{FreeSpace::Cells::clear};
  TabulatedCost table_;
  TravelCost cost_;
  Lattice lattice_;
  std::vector<PooledRoute> routes_{};
  std::vector<PooledRoute> tight_{};  ///< that only the exact check allows: for classes without another route
  unsigned iterations_{};
};

std::vector<PooledRoute> search_all(const RouteSpace& space, const RouteRequest& request,
                                    const PoolOptions& options) {
  Pool pool(space, request);
  if (!pool.straight()) {
    pool.search_cells();
    pool.search_outline();
    const int searches = request.cost.rate ? 2 * options.searches : options.searches;
    for (int k = 0; k < searches; ++k)
      pool.search(request.seed + kSeedStride * static_cast<std::uint64_t>(k));
    if (options.classes > 1) pool.search_away(options.classes);
  }
  return std::move(pool).routes();
}

}  // namespace

double corner_angles_rad(const std::vector<Point2>& line) {
  double sum_rad = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const double in_rad = std::atan2(line[i][1] - line[i - 1][1], line[i][0] - line[i - 1][0]);
    const double out_rad = std::atan2(line[i + 1][1] - line[i][1], line[i + 1][0] - line[i][0]);
    sum_rad += std::abs(wrapped_angle_rad(out_rad - in_rad));
  }
  return sum_rad;
}

EndHeadings end_headings(const RouteSpace& space, const RouteRequest& request) {
  EndHeadings headings;
  if (space.checker().is_disc()) return headings;
  if (!request.start_heading_free) headings[0] = request.start.heading_rad;
  headings[1] = request.goal_heading_rad;
  return headings;
}

std::vector<PooledRoute> pool_routes(const RouteSpace& space, const RouteRequest& request,
                                     const PoolOptions& options) {
  std::vector<PooledRoute> routes = space.routes().find_or_search(
      request, end_headings(space, request), options, [&] { return search_all(space, request, options); });
  for (PooledRoute& route : routes) route.cost += request.cost.per_rad * corner_angles_rad(route.polyline_m);
  std::stable_sort(routes.begin(), routes.end(),
                   [](const PooledRoute& a, const PooledRoute& b) { return a.cost < b.cost; });
  // Routes that the outline cannot drive may turn out to be none: the cheapest that it can is the measure.
  const auto fits = [](const PooledRoute& route) { return route.outline_fits; };
  auto surest = std::find_if(routes.begin(), routes.end(), fits);
  if (surest == routes.end()) surest = routes.begin();
  const double dearest = routes.empty() ? 0.0 : options.dearest_ratio * surest->cost;
  const auto last = std::max<std::ptrdiff_t>(options.classes - 1, 0);
  if (surest - routes.begin() > last) std::rotate(routes.begin() + last, surest, surest + 1);
  std::erase_if(routes, [&](const PooledRoute& route) { return route.cost > dearest; });
  if (routes.size() > static_cast<std::size_t>(options.classes))
    routes.resize(static_cast<std::size_t>(options.classes));
  return routes;
}

}  // namespace joulepath
