#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planner/path/floor/free_space.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// Cost of a metre of travel: the search minimizes the integral of `rate` along the way.
struct TravelCost {
  /// Cost per metre at a point, heading along the travel; absent: `least_rate` everywhere (length).
  std::function<double(double x_m, double y_m, double heading_rad)> rate{};
  double least_rate{1.0};  ///< positive lower bound of `rate`; a tighter bound makes the search faster
  double per_rad{};        ///< cost of a corner per radian: used to rank routes, not in the search
};

/// A search for the cheapest polyline of a disc between two points.
struct SearchRequest {
  Point2 start_m{};
  Point2 goal_m{};
  FreeSpace::Cells cells{FreeSpace::Cells::clear};  ///< cells that the disc may use
  TravelCost cost{};
  std::uint64_t seed{1};
  unsigned max_iterations{30000};  ///< of the planner's loop; the search does not read a clock
  unsigned patience{5000};  ///< stop after so many iterations without an improvement of the cost by 0.2 %
};

struct SearchResult {
  std::vector<Point2> polyline_m{};  ///< empty: nothing found within the budget
  double cost{};                     ///< integral of the rate along it
  unsigned iterations{};
};

/// Searches with OMPL's BIT* in R^2. The same request gives the same bytes, on any number of threads: every
/// random number comes from the request's seed.
[[nodiscard]] SearchResult search_polyline(const FreeSpace& space, const SearchRequest& request);

/// Cost of a polyline under a travel cost, corners left out.
[[nodiscard]] double polyline_cost(const std::vector<Point2>& polyline_m, const TravelCost& cost);

}  // namespace joulepath
