#pragma once

#include <optional>
#include <vector>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

/// A curve of direction segments through exact poses of one drive without a stop: those that a planner wrote,
/// not those that a robot measured. Curves that begin or end nearly as a turn in place, which no polynomial
/// in x and y follows, are found again from their poses.
///
/// Knots are some of the poses. Angles phi between travel and turning (DirectionSegment) at the knots and
/// lengths between them are the least squares of the misses of the next knot, from the knot before, as in
/// multiple shooting:
///
///   min sum_i |pose(from p_i, phi_i, phi_i+1, tau_i) - p_i+1|^2 + w^2 sum_i (phi_i - line_i)^2
///
/// with headings times a length, and line_i between phi_i-1 and phi_i+1 at the length of knot i. The segments
/// then follow each other from the first pose; the least change of phi brings them to every few knots and to
/// the last pose.
///
/// `poses`: headings of the tangent (in reverse the robot's plus pi), no two in one place. Nothing where a
/// pose is farther than `tolerance_m` from the curve or its heading more than 3 mrad off: noise, or poses too
/// far apart.
[[nodiscard]] std::optional<Curve> direction_fit(const std::vector<Pose>& poses, double tolerance_m,
                                                 Direction direction);

}  // namespace joulepath
