#pragma once

#include <vector>

#include "planner/profile/costate.hpp"

// Design: docs/decisions/0160-a-bound-by-weak-duality.md
namespace joulepath {

/// By how much a profile's cost may be above the least one.
struct DualGap {
  std::vector<double> of_segment{};  ///< J, each >= 0
  double at_nodes{};                 ///< where the costate jumps
  double elsewhere{};                ///< of the sum: cheapest rates are not those around the profile's
  double total() const;
  /// Whether that is much of the gap: the problem is not convex here.
  bool is_elsewhere() const;
};

/// The dual gap of a profile in the continuous problem as asked, valid for every costate p(s):
///
///   J >= integral over s of min over (u, a) [H(u, a)/u - p' u^2 - 2 p a] ds + p u^2 | ends - sum of jumps,
///
/// as d(p u^2)/ds = p' u^2 + 2 p a along every profile. The minimum is over all rates and accelerations that
/// the limits allow at the place; neither a grid nor convexity is assumed. The gap is the integral of what
/// the profile's own (u, a) are above that minimum: a quantity of second order, so that a few samples
/// per segment bound it (Simpson's rule and its whole difference from the one of half the step).
[[nodiscard]] DualGap dual_gap(const CostModel& model, const Costate& costate, const Profile& profile);

}  // namespace joulepath
