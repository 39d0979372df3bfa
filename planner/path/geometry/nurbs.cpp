#include "planner/path/geometry/nurbs.hpp"

#include <algorithm>
#include <cmath>

// Method: [Ramshaw1989]
namespace joulepath {
namespace {

using Point = RationalBezier::Point;

/// Blossom of the polynomial piece on [u_k, u_k+1] at `degree` arguments.
Point blossom(const Nurbs& nurbs, std::size_t k, const std::vector<double>& arguments) {
  const std::size_t p = nurbs.degree;
  const std::vector<double>& u = nurbs.knots;
  std::vector<Point> d(nurbs.points.begin() + static_cast<std::ptrdiff_t>(k - p),
                       nurbs.points.begin() + static_cast<std::ptrdiff_t>(k + 1));
  for (std::size_t r = 1; r <= p; ++r)
    for (std::size_t j = p; j >= r; --j) {
      const double low = u[j + k - p], high = u[j + 1 + k - r];
      const double share = (arguments[r - 1] - low) / (high - low);
      for (std::size_t axis = 0; axis < 3; ++axis)
        d[j][axis] = (1 - share) * d[j - 1][axis] + share * d[j][axis];
    }
  return d[p];
}

}  // namespace

std::vector<RationalBezier> bezier_pieces(const Nurbs& nurbs) {
  const std::size_t p = nurbs.degree;
  std::vector<RationalBezier> pieces;
  for (std::size_t k = p; k < nurbs.points.size(); ++k) {
    const double from = nurbs.knots[k], to = nurbs.knots[k + 1];
    if (!(from < to)) continue;
    RationalBezier piece;
    std::vector<double> arguments(p, from);
    piece.points.push_back(blossom(nurbs, k, arguments));
    for (std::size_t j = p; j-- > 0;) {
      arguments[j] = to;
      piece.points.push_back(blossom(nurbs, k, arguments));
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

CurveSegment segment_of(const RationalBezier& piece) {
  if (!piece.straight()) return BezierSegment::rational(piece);
  const auto first = piece.place_m(0), last = piece.place_m(piece.points.size() - 1);
  const double x = last[0] - first[0], y = last[1] - first[1];
  return LinearCurvature({first[0], first[1], std::atan2(y, x)}, std::hypot(x, y));
}

double least_speed(const RationalBezier& piece) {
  constexpr int kPlaces = 128;
  const double scale_m = piece.polygon_length_m();
  if (!(scale_m > 0)) return 0;
  double least = kPlaces;
  for (int i = 0; i <= kPlaces; ++i) {
    const auto first_m = bezier_derivatives(piece, static_cast<double>(i) / kPlaces).first_m;
    least = std::min(least, std::hypot(first_m[0], first_m[1]) / scale_m);
  }
  return least;
}

}  // namespace joulepath
