#pragma once

#include <vector>

#include "planner/path/shape/waypoint_path.hpp"

namespace joulepath {

/// A path along poses that another program planned or a robot drove: forward or in reverse, as the headings
/// say, a curve for each stretch without a stop, with turns in place where only the heading changes and
/// stops where the direction of travel does. Curves come within `tolerance_m` of each pose's place and keep
/// the headings of the first and the last pose of each stretch. Poses of a planner are followed within 2 mm
/// (direction_fit), and a stop is seen where they slow down and then turn otherwise. Measured poses, steps of
/// the curvature, and all poses within more than the usual tolerance get a smoothing spline.
///
/// Headings count where nine of ten are within 0.5 rad of the motion or of its opposite; otherwise (planners
/// may leave them at zero) only the places do, driven forward (curve_through). Requires two poses or more.
[[nodiscard]] WaypointPath path_along_poses(const std::vector<Pose>& poses,
                                            double tolerance_m = kWaypointTolerance_m);

}  // namespace joulepath
