#pragma once

#include "model/trajectory.hpp"

namespace joulepath {

/// How a path bends at a place.
struct PathBend {
  double curvature_per_m{};         ///< d heading / d s; the yaw rate is curvature * ds/dt
  double curvature_slope_per_m2{};  ///< d curvature / d s
};

/// State of a path after a length s of travel (s >= 0 grows along the travel, also in reverse).
struct PathPoint {
  Pose pose{};               ///< of the axle midpoint; heading of the ROBOT, continuous, not wrapped
  double curvature_per_m{};  ///< as in PathBend
  double curvature_slope_per_m2{};
};

}  // namespace joulepath
