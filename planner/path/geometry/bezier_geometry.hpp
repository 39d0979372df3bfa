#pragma once

#include <cmath>

#include "model/prescribed_motion.hpp"

namespace joulepath {

/// Length of the polygon p0 p1 p2 p3: an upper bound of the curve's.
inline double control_polygon_length_m(const BezierPoints& p) {
  double sum_m = 0;
  for (std::size_t i = 0; i < 3; ++i) sum_m += std::hypot(p[i + 1][0] - p[i][0], p[i + 1][1] - p[i][1]);
  return sum_m;
}

/// Whether all control points lie on one line (to 1e-12 of the polygon's length): the curve is straight.
inline bool on_a_line(const BezierPoints& p) {
  const double scale_m = control_polygon_length_m(p);
  double direction_x = 0, direction_y = 0, longest_m = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    const double x = p[i][0] - p[0][0], y = p[i][1] - p[0][1], length_m = std::hypot(x, y);
    if (length_m > longest_m) {
      direction_x = x / length_m;
      direction_y = y / length_m;
      longest_m = length_m;
    }
  }
  for (std::size_t i = 1; i < 4; ++i) {
    const double off_m = direction_x * (p[i][1] - p[0][1]) - direction_y * (p[i][0] - p[0][0]);
    if (std::abs(off_m) > 1e-12 * scale_m) return false;
  }
  return true;
}

}  // namespace joulepath
