#pragma once

#include <vector>

#include "planner/profile/costate.hpp"

// Design: docs/decisions/0303-bounds.md
// Method: [Vinter1993]
namespace joulepath {

/// Upper bound of the difference between a profile's cost and the least one.
struct DualGap {
  std::vector<double> of_segment{};  ///< J, each >= 0
  double at_nodes{};                 ///< where the costate jumps
  double elsewhere{};                ///< of the sum: minima that are not near the profile's own rates
  double total() const;
  /// Whether that is a large share of the gap: the problem is not convex here.
  bool is_elsewhere() const;
};

/// The dual gap of a profile in the continuous problem, valid for every costate p(s):
///
///   J >= integral over s of min over (u, a) [H(u, a)/u - p' u^2 - 2 p a] ds + p u^2 | ends - sum of jumps,
///
/// as d(p u^2)/ds = p' u^2 + 2 p a along every profile. The minimum is over all rates and accelerations
/// within the limits at the place; neither a grid nor convexity is assumed. The gap is the integral of the
/// difference between the value at the profile's own (u, a) and that minimum. It is of second order, so a few
/// samples per segment bound it (Simpson's rule plus its full difference from the rule with half the step).
[[nodiscard]] DualGap dual_gap(const CostModel& model, const Costate& costate, const Profile& profile);

}  // namespace joulepath
