#pragma once

#include <algorithm>

#include "planner/path/floor/footprint_checker.hpp"

namespace joulepath {

/// Calls visit(s, pose, slack_m) along a piece of way from s = 0 to its length until it returns false. A step
/// is so short that no point of the outline can reach an obstacle within it, but at least 2 mm of the
/// outline; 1 cm inside of an obstacle. `reach_per_s`: a point of the outline moves at most this far per unit
/// of s.
template <class Place, class Visit>
void sweep_outline(const FootprintChecker& checker, double length, double reach_per_s, const Place& place,
                   const Visit& visit) {
  constexpr double kShortestStep_m = 0.002, kStepInside_m = 0.01;
  for (double s = 0;;) {
    const Pose pose = place(s);
    const double slack_m = checker.slack_m(pose);
    if (!visit(s, pose, slack_m) || s >= length) return;
    const bool inside = slack_m < -FootprintChecker::kTolerance_m;
    const double step_m = inside ? kStepInside_m : std::max(kShortestStep_m, slack_m);
    s = std::min(length, s + step_m / reach_per_s);
  }
}

}  // namespace joulepath
