#include "model/bezier_arc.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

struct Derivatives {
  double x1{}, y1{}, x2{}, y2{};
};

/// First and second derivative of a cubic Bezier curve.                       [P1, Eq. (34)]
Derivatives derivatives(const BezierPoints& p, double t) {
  const double u = 1 - t;
  const auto first = [&](int k) {
    return 3 * (u * u * (p[1][k] - p[0][k]) + 2 * u * t * (p[2][k] - p[1][k]) + t * t * (p[3][k] - p[2][k]));
  };
  const auto second = [&](int k) {
    return 6 * (u * (p[2][k] - 2 * p[1][k] + p[0][k]) + t * (p[3][k] - 2 * p[2][k] + p[1][k]));
  };
  return {first(0), first(1), second(0), second(1)};
}

double speed_of(const BezierPoints& p, double t) {
  const Derivatives d = derivatives(p, t);
  return std::hypot(d.x1, d.y1);
}

double curvature_of(const BezierPoints& p, double t) {
  const Derivatives d = derivatives(p, t);
  const double speed = std::hypot(d.x1, d.y1);
  return speed > 1e-9 ? (d.x1 * d.y2 - d.y1 * d.x2) / (speed * speed * speed) : 0.0;
}

}  // namespace

BezierArc::BezierArc(const std::vector<BezierPoints>& chain, int samples_per_curve) {
  double length_m = 0;
  for (const BezierPoints& p : chain)
    for (int i = 0; i <= samples_per_curve; ++i) {
      const double t = static_cast<double>(i) / samples_per_curve;
      const double h = 1.0 / samples_per_curve;
      if (i > 0)  // Simpson's rule
        length_m += h / 6 * (speed_of(p, t - h) + 4 * speed_of(p, t - h / 2) + speed_of(p, t));
      arc_length_m_.push_back(length_m);
      curvature_per_m_.push_back(curvature_of(p, t));
    }
}

double BezierArc::curvature_per_m(double arc_length_m) const {
  const auto above = std::upper_bound(arc_length_m_.begin(), arc_length_m_.end(), arc_length_m);
  if (above == arc_length_m_.begin() || above == arc_length_m_.end()) return 0.0;
  const std::size_t k = static_cast<std::size_t>(above - arc_length_m_.begin());
  const double u = (arc_length_m - arc_length_m_[k - 1]) / (arc_length_m_[k] - arc_length_m_[k - 1]);
  return curvature_per_m_[k - 1] + u * (curvature_per_m_[k] - curvature_per_m_[k - 1]);
}

}  // namespace joulepath
