#pragma once

#include <optional>
#include <vector>

#include "model/prescribed_motion.hpp"
#include "planner/path/geometry/arc_cell.hpp"
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
/// The curve is halved into parts on which an ArcCell has t(s) as a polynomial: until it solves dt/ds = 1 /
/// |B'| to 1e-13 of the control polygon's length.
class BezierSegment {
 public:
  explicit BezierSegment(const BezierPoints& points_m);
  static BezierSegment rational(const RationalBezier& curve);

  double length_m() const { return length_m_; }
  PathPoint at(double s_m) const;
  PathBend bend(double s_m) const;  ///< the same without the pose, in less time
  std::array<double, 2> position_m(double s_m) const { return derivatives(parameter(s_m)).position_m; }
  /// Upper bound of |kappa|, from the hulls of B' on parts of the curve; infinite where it cannot tell.
  double curvature_bound_per_m() const;
  /// Curve parameter at an arc length.
  double parameter(double s_m) const;
  const BezierPoints& points_m() const { return points_m_; }                   ///< of a cubic
  const std::optional<RationalBezier>& rational() const { return rational_; }  ///< else

 private:
  struct Part {
    double s_m{};  ///< at its start, as the heading and the tangent
    double heading_rad{};
    std::array<double, 2> tangent_m{};  ///< B'
    ArcCell cell{};
  };
  BezierSegment() = default;
  void tabulate();
  BezierDerivatives derivatives(double t) const {
    return rational_ ? bezier_derivatives(*rational_, t) : bezier_derivatives(points_m_, t);
  }
  std::array<double, 2> velocity_m(double t) const;  ///< B'
  void refine(double from_t, double to_t, int depth);
  void append(const ArcCell& cell, const std::array<double, 2>& tangent_m);
  const Part& part_at(double s_m) const;

  BezierPoints points_m_{};  ///< of a cubic
  std::array<std::array<double, 3>, 2>
      velocity_coefficients_m_{};             ///< of a cubic: B' = c[0] + c[1] t + c[2] t² per axis
  std::optional<RationalBezier> rational_{};  ///< else
  double scale_m_{};
  double length_m_{};
  std::vector<Part> parts_{};
};

}  // namespace joulepath
