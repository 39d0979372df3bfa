#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/footprint_checker.hpp"
#include "planner/path/path.hpp"
#include "planner/path/polygon_distance.hpp"

namespace joulepath {

/// What a path costs; infinity where it cannot be driven. Typically the energy of the path's best speed
/// profile plus the price of its time.
using PathCost = std::function<double(const Path&)>;

struct RefineOptions {
  int max_evaluations{400};         ///< of the path's cost, all starts together
  double first_step_m{0.15};        ///< of the control points
  double relative_tolerance{1e-5};  ///< of the cost
};

struct RefineResult {
  Path path{};           ///< the best found; the initial one where nothing was better
  double cost_before{};  ///< of the initial path
  double cost{};         ///< of `path`
  int evaluations{};
  bool improved{};
  std::vector<Point2> polyline_m{};  ///< corners that the control points of `path` stand about
};

/// Moves the Bezier control points of a route's corners so that the path's cost falls (NLopt, COBYLA).
///
/// Each inner vertex V of the polyline becomes a chain of four cubic Bezier curves: the uniform cubic
/// B-spline with the control points V - 3a, V - 2a, V - a, V, V + b, V + 2b, V + 3b, where a and b point
/// along the incoming and outgoing line. It joins the straight lines with zero curvature and has
/// continuous curvature inside. Variables are V and the lengths of a and b of all corners together;
/// constraints are the footprint's clearance along each corner and straight line, and that corners do not
/// overlap. The result is checked along its whole length; what is not better and free is not returned.
/// Turns in place at the ends are kept from the initial path. Deterministic.
[[nodiscard]] RefineResult refine_path(const FootprintChecker& checker, const Path& initial,
                                       const std::vector<Point2>& polyline_m, const PathCost& cost,
                                       const RefineOptions& options = {});

/// The path of such corners; absent where corners overlap or a corner is too sharp (above 2.7 rad).
struct SplineCorner {
  Point2 vertex_m{};
  double before_m{};  ///< |a|
  double after_m{};   ///< |b|
};
[[nodiscard]] std::optional<Path> spline_path(const Point2& start_m, const std::vector<SplineCorner>& corners,
                                              const Point2& goal_m);

}  // namespace joulepath
