#pragma once

#include <optional>
#include <vector>

#include "model/prescribed_motion.hpp"
#include "planner/path/geometry/path_point.hpp"
#include "planner/path/geometry/rational_bezier.hpp"

namespace joulepath {

/// Position and derivatives of a cubic Bezier at t in [0, 1] [P1, Eq. (34)].
[[nodiscard]] BezierDerivatives bezier_derivatives(const BezierPoints& points_m, double t);

/// A regular Bezier curve, cubic or rational (|B'| > 0 on [0, 1]: see bezier_chain.hpp and nurbs.hpp), by arc
/// length.
///
///   kappa = B' x B'' / |B'|^3,
///   d kappa / d s = (B' x B''' / |B'|^3 - 3 (B' x B'') (B' . B'') / |B'|^5) / |B'|
///
/// s(t) is tabulated by adaptive Gauss-Legendre quadrature; t(s) by Newton's method to 1e-13 of the control
/// polygon's length.
class BezierSegment {
 public:
  explicit BezierSegment(const BezierPoints& points_m);
  static BezierSegment rational(const RationalBezier& curve);

  double length_m() const { return knots_.back().s_m; }
  PathPoint at(double s_m) const;
  /// Curve parameter at an arc length.
  double parameter(double s_m) const;
  const BezierPoints& points_m() const { return points_m_; }  ///< of a cubic
  const std::optional<RationalBezier>& rational_curve() const { return rational_; }

 private:
  struct Knot {
    double t{};
    double s_m{};
    double speed_m{};  ///< |B'|
    double heading_rad{};
    std::array<double, 2> tangent_m{};  ///< B'
  };
  BezierSegment() = default;
  void tabulate();
  BezierDerivatives derivatives(double t) const {
    return rational_ ? bezier_derivatives(*rational_, t) : bezier_derivatives(points_m_, t);
  }
  double speed_m(double t) const;
  double arc_m(double from_t, double to_t) const;
  void refine(double from_t, double to_t, double whole_m, int depth);
  void append_knot(double t, double arc_from_last_m);
  const Knot& knot_before(double s_m) const;

  BezierPoints points_m_{};                   ///< of a cubic
  std::array<std::array<double, 3>, 2> velocity_m_{};  ///< of a cubic: B' = c[0] + c[1] t + c[2] t² per axis
  std::optional<RationalBezier> rational_{};           ///< else
  double scale_m_{};
  std::vector<Knot> knots_{};
};

}  // namespace joulepath
