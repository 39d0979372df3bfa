#pragma once

#include <variant>
#include <vector>

#include "planner/path/geometry/bezier.hpp"
#include "planner/path/geometry/direction_segment.hpp"
#include "planner/path/geometry/linear_curvature.hpp"
#include "planner/path/geometry/path_point.hpp"

namespace joulepath {

enum class Direction { forward, reverse };

/// One smooth stretch with its own arc length from 0; heading is that of the tangent.
using CurveSegment = std::variant<LinearCurvature, BezierSegment, DirectionSegment>;

/// A planar curve by arc length with continuous position, heading and curvature.
///
/// s in [0, length] grows along the travel. In reverse the heading is opposite to the tangent, the signed
/// speed is -ds/dt, and the curvature is still d heading / d s.
class Curve {
 public:
  /// Largest steps accepted at a joint of two segments: the rounding of input files.
  static constexpr double kPositionTolerance_m = 1e-6;
  static constexpr double kHeadingTolerance_rad = 1e-6;
  static constexpr double kCurvatureTolerance_per_m = 1e-3;

  /// The segments must meet within the tolerances (asserted: the caller checks the input).
  explicit Curve(std::vector<CurveSegment> segments, Direction direction = Direction::forward);

  double length_m() const { return breakpoints_m_.back(); }
  Direction direction() const { return direction_; }
  /// s outside of [0, length] is taken as the nearer end.
  PathPoint at(double s_m) const;
  PathBend bend(double s_m) const;  ///< the same without the pose, in less time
  std::array<double, 2> position_m(double s_m) const;
  /// Where the segments meet, both ends included, ascending: kappa' may jump there, kappa does not.
  const std::vector<double>& breakpoints_m() const { return breakpoints_m_; }
  const std::vector<CurveSegment>& segments() const { return segments_; }
  /// Index of the segment at an arc length within the curve.
  std::size_t segment_at(double s_m) const;

 private:
  std::vector<CurveSegment> segments_{};
  Direction direction_{};
  std::vector<double> breakpoints_m_{};
  std::vector<double> heading_offset_rad_{};  ///< whole turns (and pi in reverse) added to each segment
};

}  // namespace joulepath
