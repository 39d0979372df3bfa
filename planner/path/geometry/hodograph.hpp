#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "planner/path/geometry/bezier.hpp"

namespace joulepath {

/// A cubic's derivative between two parameters as a quadratic Bezier curve with control points h: its hull
/// bounds the derivative's size and direction from below and above.
class Hodograph {
 public:
  Hodograph(const BezierPoints& points_m, double from_t, double to_t) : step_(to_t - from_t) {
    const BezierDerivatives from = bezier_derivatives(points_m, from_t),
                            to = bezier_derivatives(points_m, to_t);
    for (std::size_t k = 0; k < 2; ++k) {
      h_[0][k] = from.first_m[k];
      h_[1][k] = from.first_m[k] + 0.5 * step_ * from.second_m[k];
      h_[2][k] = to.first_m[k];
    }
  }
  /// Lower bound of |B'|; negative where the hull surrounds the origin.
  double least_m() const {
    constexpr double kStandstill_m = 1e-9;  // shorter tangents have no direction
    const Vector sum{h_[0][0] + h_[2][0], h_[0][1] + h_[2][1]};
    const double size = std::max(std::sqrt(dot(sum, sum)), kStandstill_m);
    return std::min({dot(h_[0], sum), dot(h_[1], sum), dot(h_[2], sum)}) / size;
  }
  /// Upper bound of |kappa| = |B' x B''| / |B'|^3; infinite where the hull surrounds the origin.
  double curvature_bound_per_m() const {
    const double least = least_m();
    return least > 0 ? most_bend_m2() / (least * least * least) : std::numeric_limits<double>::infinity();
  }

 private:
  using Vector = std::array<double, 2>;
  static double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1]; }
  static double cross(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }
  /// Upper bound of |B' x B''|: the largest of its Bernstein coefficients.
  double most_bend_m2() const {
    return 2 / step_ *
           std::max({std::abs(cross(h_[0], h_[1])), 0.5 * std::abs(cross(h_[0], h_[2])),
                     std::abs(cross(h_[1], h_[2]))});
  }

  Vector h_[3];
  double step_;  ///< between the parameters
};

}  // namespace joulepath
