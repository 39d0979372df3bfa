#pragma once

#include <optional>

#include "planner/bound/rate_table.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

// Design: docs/nlp.md, "What the bound over all paths means"
namespace joulepath {

/// Ends of a drive from rest to rest: where the goal lies from the start, and the headings there; absent:
/// free.
struct HeadingEnds {
  Point2 offset_m{};
  std::optional<double> start_rad{}, goal_rad{};
};

/// A certified lower bound (J, time at its price included) of every motion between two poses whose way is
/// between `least_m` and `most_m` long, both at least the line's length; 0 where both headings are free. It
/// is the best over multipliers lambda (J/m) of lambda.offset + the least cost of HeadingProgram at the
/// goal's heading; `enough_J`: the search for lambda ends where the bound is above it.
[[nodiscard]] double heading_bound(const RateTable& table, const HeadingEnds& ends, double least_m,
                                   double most_m, double enough_J);

}  // namespace joulepath
