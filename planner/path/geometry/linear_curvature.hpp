#pragma once

#include <array>
#include <vector>

#include "planner/path/geometry/path_point.hpp"

namespace joulepath {

/// A straight line, circle arc or clothoid: curvature linear in arc length.
///
///   kappa(s) = kappa0 + kappa0' s,   heading(s) = heading0 + kappa0 s + kappa0' s^2 / 2
///
/// Position is the integral of (cos, sin) of the heading: closed form where kappa' = 0, otherwise
/// 8-point Gauss-Legendre from the nearest of tabulated cells that turn by at most 0.5 rad (error
/// below 1e-14 of the length).
class LinearCurvature {
 public:
  LinearCurvature(const Pose& start, double length_m, double curvature_per_m = 0,
                  double curvature_slope_per_m2 = 0);

  double length_m() const { return length_m_; }
  PathPoint at(double s_m) const;
  std::array<double, 2> position_m(double s_m) const {
    const Pose pose = at(s_m).pose;
    return {pose.x_m, pose.y_m};
  }
  PathBend bend(double s_m) const { return {curvature_ + slope_ * s_m, slope_}; }
  const Pose& start() const { return start_; }
  double curvature_per_m() const { return curvature_; }  ///< at the start
  double curvature_slope_per_m2() const { return slope_; }

 private:
  double heading_rad(double s_m) const {
    return start_.heading_rad + s_m * (curvature_ + 0.5 * slope_ * s_m);
  }
  Pose advance(const Pose& from, double from_s_m, double to_s_m) const;

  Pose start_{};
  double length_m_{};
  double curvature_{};
  double slope_{};
  double cell_m_{};
  std::vector<Pose> cells_{};  ///< pose at the start of each cell; only clothoids have any
};

}  // namespace joulepath
