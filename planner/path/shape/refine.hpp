#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/shape/blended_path.hpp"

namespace joulepath {

/// The cost of a path; infinite if it cannot be driven. Typically the energy of the path's best speed profile
/// plus the price of its time.
using PathCost = std::function<double(const Path&)>;

struct RefineOptions {
  int evaluations_per_corner{30};   ///< of the path's cost; all corners move at once
  double first_step_m{0.15};        ///< of the control points
  double relative_tolerance{1e-5};  ///< of the cost
  bool keep_start_heading{};        ///< keep the initial path's heading at the start
  bool keep_goal_heading{};
};

struct RefineResult {
  Path path{};           ///< the best path found; the initial one if none is better
  double cost_before{};  ///< of the initial path
  double cost{};         ///< of `path`
  int evaluations{};
  bool improved{};
};

/// Moves the Bezier control points of a path's corners so that its cost falls (NLopt, COBYLA).
///
/// Each corner V becomes a chain of three cubic Bezier curves: the uniform cubic B-spline with three control
/// points on the incoming line, the last of them a before V, and three on the outgoing one, the first of them
/// b after V, spaced as those two are apart. It joins the straight lines with zero curvature and has
/// continuous curvature inside. Variables are V, a and b of all corners together, first guessed from the
/// initial path's blends. Constraints are the footprint's clearance along the path, and that corners do not
/// overlap. If an end heading is kept, the corner next to it moves along that end's line only. The result is
/// checked along its whole length; it is returned only if it is better and free. Deterministic.
[[nodiscard]] RefineResult refine_path(const FootprintChecker& checker, const SmoothPath& initial,
                                       const PathCost& cost, const RefineOptions& options = {});

/// The path with such corners; absent if corners overlap or a corner is too sharp (above 2.7 rad).
struct SplineCorner {
  Point2 vertex_m{};
  double before_m{};  ///< a
  double after_m{};   ///< b
};
/// Distance from a corner of this turn back to the beginning of its curve, or on to its end.
[[nodiscard]] double spline_tangent_m(const SplineCorner& corner, double turn_rad, bool before);
[[nodiscard]] std::optional<Path> spline_path(const Point2& start_m, const std::vector<SplineCorner>& corners,
                                              const Point2& goal_m);

}  // namespace joulepath
