#pragma once

#include <vector>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

/// Quintic Bezier curves along [from_m, to_m] of a curve that match its position, heading and curvature at
/// their ends and stay within `tolerance_m` of it, for programs without clothoids. They are halved until they
/// do.
[[nodiscard]] std::vector<RationalBezier> quintic_fit(const Curve& curve, double from_m, double to_m,
                                                      double tolerance_m);

}  // namespace joulepath
