#pragma once

#include <string>
#include <vector>

#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// A defect or a note at a place of a chain of Bezier curves.
struct BezierFinding {
  enum class Kind {
    not_finite,           ///< a control point is not a finite number
    no_length,            ///< all four control points coincide within kRounding_m
    cusp,                 ///< the tangent vanishes and turns back inside of a curve
    unbounded_curvature,  ///< the tangent vanishes at an end (p0 == p1 or p2 == p3) of a curve that bends
    gap,                  ///< a curve does not begin at the end of the previous one (or at the robot)
    curvature_step,       ///< only a note: curvature jumps at the joint, so the robot stops there
    heading_step          ///< only a note: the heading breaks at the joint, so the robot turns in place
  };
  Kind kind{};
  std::size_t curve{};  ///< index in the chain; at a joint, of the later curve
  double t{};           ///< parameter in that curve
  double x_m{};         ///< place in the map frame
  double y_m{};
  double amount{};  ///< of the gap (m), heading step (rad) or curvature step (1/m), else 0
  std::string message{};
};

/// The path along a chain, or the defects that prevent it.
struct BezierChainResult {
  Path path{};                           ///< empty if there are defects
  std::vector<BezierFinding> defects{};  ///< the chain cannot be driven as given
  std::vector<BezierFinding> notes{};    ///< the chain can be driven, with stops at these joints

  bool ok() const { return defects.empty(); }
};

enum class BezierFrame { start, map };

/// Drives a chain of cubic Bezier curves forward from a pose.
///
/// Control points are in the robot's frame at its start (BezierFrame), else in the map frame. The
/// chain must begin at the robot and each curve at the end of the previous one (steps up to kRounding_m and
/// kRounding_rad are rounding: p0 and p1 of the later curve are moved to close them). At a heading step, at
/// the beginning too, the robot turns in place; at a curvature step alone it stops. Curves with all control
/// points on one line become exactly straight.
[[nodiscard]] BezierChainResult bezier_chain(const std::vector<BezierPoints>& curves_m, const Pose& start,
                                             BezierFrame frame);

/// Defects of a single curve: not_finite, no_length, cusp, unbounded_curvature.
[[nodiscard]] std::vector<BezierFinding> bezier_defects(const BezierPoints& points_m, std::size_t curve);

}  // namespace joulepath
