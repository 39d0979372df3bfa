#pragma once

#include <optional>

#include "planner/bound/rate_table.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

// Design: docs/nlp.md, "Headings at the ends"
namespace joulepath {

/// Ends of a drive from rest to rest: where the goal lies from the start, and the headings there; absent:
/// free.
struct HeadingEnds {
  Point2 offset_m{};
  std::optional<double> start_rad{}, goal_rad{};
};

/// A certified lower bound (J, time at its price included) of every motion between two poses whose way is
/// between `least_m` and `most_m` long, both at least the line's length. For any price lambda of the place
/// (J/m), W(sigma, heading) is a bilinear function on a grid from a dynamic program; with
///   W_sigma <= H(W_heading) - lambda.u(heading) + residual(sigma),   H(q) the rate at the price q,
/// the energy is at least lambda.offset + W at the goal's heading less the integral of the residual, which is
/// evaluated for all headings of a cell at once. Headings are not taken modulo a turn. `enough_J`: the search
/// for lambda ends where the bound is above it.
[[nodiscard]] double heading_bound(const RateTable& table, const HeadingEnds& ends, double least_m,
                                   double most_m, double enough_J);

}  // namespace joulepath
