#pragma once

#include <vector>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

/// Quintic Bezier curves along [from_m, to_m] of a curve that match its position, heading and curvature at
/// their ends, for programs without clothoids. They are halved until they stay within `tolerance_m` of it and
/// are turned from it by at most 1 mrad: on a short tight curve a small distance alone says little of what
/// turning takes.
[[nodiscard]] std::vector<RationalBezier> quintic_fit(const Curve& curve, double from_m, double to_m,
                                                      double tolerance_m);

}  // namespace joulepath
