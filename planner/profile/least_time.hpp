#pragma once

#include <vector>

#include "planner/profile/place_cost.hpp"

// Design: docs/decisions/0303-bounds.md
// Method: [Bobrow1985]
namespace joulepath {

/// The least time of the continuous problem, bounded from below.
struct LeastTime {
  double lower_s{};                    ///< lower bound of every profile's time
  std::vector<double> of_segment_s{};  ///< its parts, by segment of the grid
  std::vector<double> switches{};      ///< places where the limit that holds the fastest drive changes
};

/// By comparison: along every profile b = u^2 stays below the solutions of
///   db/ds = 2 a_max(s, b) from the start,   db/ds = 2 a_min(s, b) back from the end,
/// and below the largest square at each place, so it takes at least the integral of ds/sqrt(b) of the least
/// of the three. Runge-Kutta steps within the segments of the grid; the change by halved steps is subtracted.
[[nodiscard]] LeastTime least_time(const CostModel& model, const std::vector<double>& s);

}  // namespace joulepath
