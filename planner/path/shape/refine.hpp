#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/shape/smoothing.hpp"

namespace joulepath {

/// What a path costs; infinity where it cannot be driven. Typically the energy of the path's best speed
/// profile plus the price of its time.
using PathCost = std::function<double(const Path&)>;

struct RefineOptions {
  int evaluations_per_corner{30};   ///< of the path's cost; all corners move at once
  double first_step_m{0.15};        ///< of the control points
  double relative_tolerance{1e-5};  ///< of the cost
  bool keep_start_heading{};        ///< leave in the heading that the path has now
  bool keep_goal_heading{};
};

struct RefineResult {
  Path path{};           ///< the best found; the initial one where nothing was better
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
/// initial path's blends; constraints are the footprint's clearance along the path, and that corners do not
/// overlap. Where an end heading is kept, the corner next to it moves along that end's line alone. The result
/// is checked along its whole length; what is not better and free is not returned. Deterministic.
[[nodiscard]] RefineResult refine_path(const FootprintChecker& checker, const SmoothPath& initial,
                                       const PathCost& cost, const RefineOptions& options = {});

/// The path of such corners; absent where corners overlap or a corner is too sharp (above 2.7 rad).
struct SplineCorner {
  Point2 vertex_m{};
  double before_m{};  ///< a
  double after_m{};   ///< b
};
/// From a corner of this turn back to where its curve begins, or on to where it ends.
[[nodiscard]] double spline_tangent_m(const SplineCorner& corner, double turn_rad, bool before);
[[nodiscard]] std::optional<Path> spline_path(const Point2& start_m, const std::vector<SplineCorner>& corners,
                                              const Point2& goal_m);

}  // namespace joulepath
