#pragma once

#include <vector>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

/// A planar NURBS curve: degree p, n control points with weights > 0, n + p + 1 ascending knots, as in a VDA
/// 5050 trajectory gives it. The curve runs over the knots' interval [u_p, u_n]; it need not be clamped.
struct Nurbs {
  std::size_t degree{};
  std::vector<double> knots{};
  std::vector<RationalBezier::Point> points{};  ///< homogeneous: (w x, w y, w)
};

/// The curve's pieces between different knots, exactly: control point j of a piece [a, b] is the blossom
/// f(a, ..., a, b, ..., b) with j times b, by de Boor's recursion in homogeneous coordinates.
[[nodiscard]] std::vector<RationalBezier> bezier_pieces(const Nurbs& nurbs);

/// A piece as a segment of a path: an exact straight line if its control points are on one.
[[nodiscard]] CurveSegment segment_of(const RationalBezier& piece);

/// Smallest |dC/dt| of a piece over its polygon's length (0 for a cusp), sampled at 129 places.
[[nodiscard]] double least_speed(const RationalBezier& piece);

}  // namespace joulepath
