#pragma once

#include <array>
#include <vector>

#include "planner/path/geometry/path_point.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath {

/// A curve segment by the direction of motion phi of a differential drive, tan phi = rho d heading / d s with
/// rho half the track. Its length tau counts both, d tau^2 = d s^2 + rho^2 d heading^2, and a share f of it
/// is f in [0, 1]:
///
///   ds/dtau = A(f) = (1 - f) cos phi_a + f cos phi_b,   rho d heading/dtau = B(f), the same of sin phi
///   kappa = B/(rho A), monotone in f;   kappa -> infinity is a turn in place
///
/// The heading is quadratic in f, as is the arc length s, which is inverted in closed form. The position is
/// the integral of (cos, sin) of the heading by 8-point Gauss-Legendre from the nearest of tabulated cells
/// that turn by at most 0.5 rad: no error beyond rounding (below 1e-13 of the length).
class DirectionSegment {
 public:
  /// Ends of the segment. |phi| < pi/2 in rad; lengths in m.
  struct Shape {
    double from_rad{};
    double to_rad{};
    double length_m{};  ///< tau, > 0
    double half_track_m{};
  };
  DirectionSegment(const Pose& start, const Shape& shape);

  double length_m() const { return arc_m_; }
  PathPoint at(double s_m) const;
  PathBend bend(double s_m) const;
  std::array<double, 2> position_m(double s_m) const;
  /// Of |kappa|, exact: it is largest at an end.
  double curvature_bound_per_m() const;
  const Pose& start() const { return start_; }
  const Shape& shape() const { return shape_; }

 private:
  double share(double s_m) const;
  double heading_rad(double f) const;
  Pose advance(const Pose& from, double from_f, double to_f) const;
  Pose pose(double f) const;

  Pose start_{};
  Shape shape_{};
  double along_{}, along_change_{};    ///< A(0), A(1) - A(0)
  double across_{}, across_change_{};  ///< B(0), B(1) - B(0)
  double arc_m_{};
  std::vector<Pose> cells_{};  ///< pose at the start of each
};

}  // namespace joulepath
