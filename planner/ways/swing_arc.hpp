#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// An angle between 0 and 2 pi.
inline double positive_rad(double angle_rad) {
  const double rest_rad = std::fmod(angle_rad, 2 * std::numbers::pi);
  return rest_rad < 0 ? rest_rad + 2 * std::numbers::pi : rest_rad;
}

/// An arc at an end of a leg, as knots and a handle of a spline: it begins at a place or, seen from the goal,
/// ends there. A positive radius turns to the left.
struct SwingArc {
  static constexpr double kLeast_rad = 0.3;  ///< of a turn that gets an arc
  static constexpr double kPart_rad = 1.8;   ///< between knots at most

  Point2 place{};
  double heading_rad{};
  double radius_m{};

  static double parts(double turn_rad) { return std::ceil(std::abs(turn_rad) / kPart_rad); }
  Point2 center_m() const {
    return {place[0] - radius_m * std::sin(heading_rad), place[1] + radius_m * std::cos(heading_rad)};
  }
  /// Places after equal parts of a turn (negative: before the place), the last at its end.
  std::vector<Point2> knots(double turn_rad) const {
    std::vector<Point2> knots;
    if (std::abs(turn_rad) < kLeast_rad) return knots;
    const Point2 center = center_m();
    for (int k = 1; k <= parts(turn_rad); ++k) {
      const double there_rad = heading_rad + turn_rad * k / parts(turn_rad);
      knots.push_back(
          {center[0] + radius_m * std::sin(there_rad), center[1] - radius_m * std::cos(there_rad)});
    }
    return knots;
  }
  /// Of an arc's first part, or of a line.
  double handle_m(double turn_rad, double line_m) const {
    if (std::abs(turn_rad) < kLeast_rad) return 0.3 * line_m;
    return 4.0 / 3 * std::tan(0.25 * std::abs(turn_rad) / parts(turn_rad)) * std::abs(radius_m);
  }
};

}  // namespace joulepath
