#pragma once

#include <vector>

#include "model/prescribed_motion.hpp"

namespace joulepath {

/// Curvature against arc length of a chain of cubic Bezier curves, tabulated for prescribed motions. Planning
/// uses the exact path geometry of planner/path/geometry.
class BezierArc {
 public:
  explicit BezierArc(const std::vector<BezierPoints>& chain, int samples_per_curve = 2000);

  double length_m() const { return arc_length_m_.back(); }

  /// Signed curvature, counter-clockwise positive; 0 beyond the ends.
  double curvature_per_m(double arc_length_m) const;

 private:
  std::vector<double> arc_length_m_{};
  std::vector<double> curvature_per_m_{};
};

}  // namespace joulepath
