#pragma once

#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// Largest violations of the relations between a piece's channels, by sampling between breakpoints: position
/// against the integral of the heading, heading against the integral of the curvature, curvature against the
/// integral of its slope (Gauss-Legendre between samples).
struct CurveBreach {
  double position_m{};
  double heading_rad{};
  double curvature_per_m{};
  double curvature_step_per_m{};  ///< across breakpoints
};

CurveBreach curve_breach(const PathPiece& piece, int samples_per_stretch = 200);

}  // namespace joulepath
