#pragma once

#include <array>
#include <vector>

namespace joulepath {

/// Position and its derivatives by the curve parameter t in [0, 1] of a Bezier curve.
struct BezierDerivatives {
  std::array<double, 2> position_m{};
  std::array<double, 2> first_m{};
  std::array<double, 2> second_m{};
  std::array<double, 2> third_m{};
};

/// A rational Bezier curve of degree points.size() - 1, from 1 to kMostDegree:
///
///   C(t) = sum B_i(t) w_i P_i / sum B_i(t) w_i,   B_i the Bernstein polynomials.
struct RationalBezier {
  static constexpr std::size_t kMostDegree = 9;
  /// A control point in homogeneous coordinates: (w x, w y, w), x and y in m, w > 0.
  using Point = std::array<double, 3>;
  std::vector<Point> points{};

  /// Length of the control polygon (m): an upper bound of the curve's.
  [[nodiscard]] double polygon_length_m() const;
  /// Whether the curve is a straight line without a reversal (control points within about 1e-6 of its
  /// length).
  [[nodiscard]] bool straight() const;
  /// Control point i in the plane.
  [[nodiscard]] std::array<double, 2> place_m(std::size_t i) const {
    return {points[i][0] / points[i][2], points[i][1] / points[i][2]};
  }
};

/// By de Casteljau's algorithm in homogeneous coordinates, C = A / w, and the quotient rule:
///   w C' = A' - w' C,   w C'' = A'' - 2 w' C' - w'' C,   w C''' = A''' - 3 w' C'' - 3 w'' C' - w''' C.
[[nodiscard]] BezierDerivatives bezier_derivatives(const RationalBezier& curve, double t);

}  // namespace joulepath
