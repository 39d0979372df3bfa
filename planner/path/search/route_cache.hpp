#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <tuple>
#include <vector>

#include "planner/path/search/route_pool.hpp"

namespace joulepath {

/// Cache of the routes searched on one floor, for later legs and missions between the same places. Safe to
/// share between threads. It holds searches for length only, because another cost needs another search.
class RouteCache {
 public:
  using Search = std::function<std::vector<PooledRoute>()>;

  std::vector<PooledRoute> find_or_search(const RouteRequest& request, const EndHeadings& headings,
                                          const PoolOptions& options, const Search& search) {
    if (request.cost.rate) return search();
    const Key key{request.start.x_m, request.start.y_m, request.goal_x_m, request.goal_y_m,
                  request.seed,      headings,          options.classes,  options.searches};
    {
      const std::lock_guard lock(mutex_);
      const auto found = routes_.find(key);
      if (found != routes_.end()) return found->second;
    }
    std::vector<PooledRoute> routes = search();  // the same for every thread
    const std::lock_guard lock(mutex_);
    return routes_.try_emplace(key, std::move(routes)).first->second;
  }

 private:
  using Key = std::tuple<double, double, double, double, std::uint64_t, EndHeadings, int, int>;
  std::mutex mutex_{};
  std::map<Key, std::vector<PooledRoute>> routes_{};
};

}  // namespace joulepath
