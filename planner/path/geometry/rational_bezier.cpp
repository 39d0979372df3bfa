#include "planner/path/geometry/rational_bezier.hpp"

#include <cmath>

#include "model/assert.hpp"

namespace joulepath {
namespace {

using Point = RationalBezier::Point;
constexpr std::size_t kOrders = 4;  // the curve and three derivatives

/// The k-th forward difference of the k + 1 points.
double difference(const std::array<Point, RationalBezier::kMostDegree + 1>& p, std::size_t k,
                  std::size_t axis) {
  switch (k) {
    case 0:
      return p[0][axis];
    case 1:
      return p[1][axis] - p[0][axis];
    case 2:
      return p[2][axis] - 2 * p[1][axis] + p[0][axis];
    default:
      return p[3][axis] - 3 * p[2][axis] + 3 * p[1][axis] - p[0][axis];
  }
}

}  // namespace

double RationalBezier::polygon_length_m() const {
  double sum_m = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto from = place_m(i), to = place_m(i + 1);
    sum_m += std::hypot(to[0] - from[0], to[1] - from[1]);
  }
  return sum_m;
}

bool RationalBezier::straight() const {
  const auto first = place_m(0), last = place_m(points.size() - 1);
  const double chord_m = std::hypot(last[0] - first[0], last[1] - first[1]);
  return std::abs(polygon_length_m() - chord_m) <= 1e-12 * chord_m;
}

BezierDerivatives bezier_derivatives(const RationalBezier& curve, double t) {
  const std::size_t count = curve.points.size(), degree = count - 1;
  JOULEPATH_ASSERT(count >= 2 && degree <= RationalBezier::kMostDegree, "degree of a rational Bezier curve");
  std::array<Point, RationalBezier::kMostDegree + 1> p{};
  for (std::size_t i = 0; i < count; ++i) p[i] = curve.points[i];
  std::array<Point, kOrders> d{};  // of the homogeneous curve
  for (std::size_t left = count; left > 0; --left) {
    if (const std::size_t order = left - 1; order < kOrders) {
      double falling = 1;
      for (std::size_t i = 0; i < order; ++i) falling *= static_cast<double>(degree - i);
      for (std::size_t axis = 0; axis < 3; ++axis) d[order][axis] = falling * difference(p, order, axis);
    }
    for (std::size_t i = 0; i + 1 < left; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) p[i][axis] += t * (p[i + 1][axis] - p[i][axis]);
  }
  BezierDerivatives out;
  const double w = d[0][2], w1 = d[1][2], w2 = d[2][2], w3 = d[3][2];
  for (std::size_t i = 0; i < 2; ++i) {
    const double c = out.position_m[i] = d[0][i] / w;
    const double c1 = out.first_m[i] = (d[1][i] - w1 * c) / w;
    const double c2 = out.second_m[i] = (d[2][i] - 2 * w1 * c1 - w2 * c) / w;
    out.third_m[i] = (d[3][i] - 3 * w1 * c2 - 3 * w2 * c1 - w3 * c) / w;
  }
  return out;
}

}  // namespace joulepath
