#include "planner/path/geometry/bezier.hpp"

#include <algorithm>
#include <cmath>

#include "model/assert.hpp"
#include "planner/path/geometry/quadrature.hpp"

namespace joulepath {
namespace {

using Vector = std::array<double, 2>;

Vector combine(double a, const Vector& u, double b, const Vector& v) {
  return {a * u[0] + b * v[0], a * u[1] + b * v[1]};
}
double cross(const Vector& u, const Vector& v) { return u[0] * v[1] - u[1] * v[0]; }
double dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1]; }
double norm(const Vector& u) { return std::sqrt(dot(u, u)); }

constexpr int kFirstIntervals = 4;
constexpr int kDeepest = 40;
constexpr double kCellTurn_rad = 0.5;
constexpr double kQuadratureTolerance = 1e-14;  // of the control polygon's length
constexpr int kNewtonSteps = 12;
constexpr double kNewtonTolerance = 1e-13;  // of the control polygon's length
constexpr double kShortStep = 0.01;         // of a cell

}  // namespace

BezierDerivatives bezier_derivatives(const BezierPoints& p, double t) {
  const double u = 1 - t;
  const Vector d0 = combine(1, p[1], -1, p[0]), d1 = combine(1, p[2], -1, p[1]),
               d2 = combine(1, p[3], -1, p[2]);
  const Vector e0 = combine(1, d1, -1, d0), e1 = combine(1, d2, -1, d1);
  BezierDerivatives out;
  for (std::size_t i = 0; i < 2; ++i) {
    out.position_m[i] =
        u * u * u * p[0][i] + 3 * u * u * t * p[1][i] + 3 * u * t * t * p[2][i] + t * t * t * p[3][i];
    out.first_m[i] = 3 * (u * u * d0[i] + 2 * u * t * d1[i] + t * t * d2[i]);
    out.second_m[i] = 6 * (u * e0[i] + t * e1[i]);
    out.third_m[i] = 6 * (e1[i] - e0[i]);
  }
  return out;
}

BezierSegment::BezierSegment(const BezierPoints& points_m) : points_m_(points_m) {
  for (std::size_t i = 0; i < 3; ++i) scale_m_ += norm(combine(1, points_m[i + 1], -1, points_m[i]));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double d0 = points_m[1][axis] - points_m[0][axis], d1 = points_m[2][axis] - points_m[1][axis],
                 d2 = points_m[3][axis] - points_m[2][axis];
    velocity_m_[axis] = {3 * d0, 6 * (d1 - d0), 3 * (d0 - 2 * d1 + d2)};
  }
  tabulate();
}

BezierSegment BezierSegment::rational(const RationalBezier& curve) {
  BezierSegment segment;
  segment.rational_ = curve;
  segment.scale_m_ = curve.polygon_length_m();
  segment.tabulate();
  return segment;
}

void BezierSegment::tabulate() {
  JOULEPATH_ASSERT(std::isfinite(scale_m_) && scale_m_ > 0, "a Bezier segment needs a positive length");
  const BezierDerivatives start = derivatives(0);
  const Vector& tangent = start.first_m;
  knots_.push_back({0, 0, norm(tangent), std::atan2(tangent[1], tangent[0]), tangent});
  for (int i = 0; i < kFirstIntervals; ++i) {
    const double from_t = static_cast<double>(i) / kFirstIntervals,
                 to_t = static_cast<double>(i + 1) / kFirstIntervals;
    refine(from_t, to_t, arc_m(from_t, to_t), 0);
  }
}

double BezierSegment::speed_m(double t) const {
  if (rational_) return norm(derivatives(t).first_m);
  const auto along = [&](const std::array<double, 3>& c) { return c[0] + t * (c[1] + t * c[2]); };
  return norm({along(velocity_m_[0]), along(velocity_m_[1])});
}

double BezierSegment::arc_m(double from_t, double to_t) const {
  return integrate_gauss8([this](double t) { return speed_m(t); }, from_t, to_t);
}

void BezierSegment::refine(double from_t, double to_t, double whole_m, int depth) {
  const double middle_t = 0.5 * (from_t + to_t);
  const double left_m = arc_m(from_t, middle_t), right_m = arc_m(middle_t, to_t);
  const Vector a = derivatives(from_t).first_m, b = derivatives(middle_t).first_m,
               c = derivatives(to_t).first_m;
  const double turn_rad =
      std::abs(std::atan2(cross(a, b), dot(a, b))) + std::abs(std::atan2(cross(b, c), dot(b, c)));
  const bool exact = std::abs(left_m + right_m - whole_m) <= kQuadratureTolerance * scale_m_;
  if (depth >= kDeepest || (exact && turn_rad <= kCellTurn_rad)) {
    append_knot(middle_t, left_m);
    append_knot(to_t, right_m);
    return;
  }
  refine(from_t, middle_t, left_m, depth + 1);
  refine(middle_t, to_t, right_m, depth + 1);
}

void BezierSegment::append_knot(double t, double arc_from_last_m) {
  const Knot& last = knots_.back();
  const Vector tangent = derivatives(t).first_m;
  const double turn_rad = std::atan2(cross(last.tangent_m, tangent), dot(last.tangent_m, tangent));
  knots_.push_back({t, last.s_m + arc_from_last_m, norm(tangent), last.heading_rad + turn_rad, tangent});
}

const BezierSegment::Knot& BezierSegment::knot_before(double s_m) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s_m,
                                      [](double s, const Knot& knot) { return s < knot.s_m; });
  const auto index = std::clamp<std::ptrdiff_t>(after - knots_.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(knots_.size()) - 2);
  return knots_[static_cast<std::size_t>(index)];
}

double BezierSegment::parameter(double s_m) const { return parameter_after(knot_before(s_m), s_m); }

double BezierSegment::parameter_after(const Knot& from, double s_m) const {
  const Knot& to = *(&from + 1);
  // Cubic Hermite interpolation of t(s), dt/ds = 1 / |B'|, then Newton on the exact arc length.
  const double h_m = to.s_m - from.s_m, x = std::clamp((s_m - from.s_m) / h_m, 0.0, 1.0), dt = to.t - from.t;
  const double m0 = h_m / from.speed_m, m1 = h_m / to.speed_m;
  const double guess = from.t + x * (m0 + x * ((3 * dt - 2 * m0 - m1) + x * (m0 + m1 - 2 * dt)));
  double t = std::clamp(guess, from.t, to.t), excess_m = from.s_m + arc_m(from.t, t) - s_m;
  for (int step = 0; step < kNewtonSteps && std::abs(excess_m) > kNewtonTolerance * scale_m_; ++step) {
    const double next = std::clamp(t - excess_m / speed_m(t), from.t, to.t);
    // A step this short is integrated to rounding by three points.
    excess_m += std::abs(next - t) <= kShortStep * dt
                    ? integrate_gauss3([this](double u) { return speed_m(u); }, t, next)
                    : arc_m(t, next);
    t = next;
  }
  return t;
}

PathPoint BezierSegment::at(double s_m) const {
  const Knot& from = knot_before(s_m);
  const BezierDerivatives d = derivatives(parameter_after(from, s_m));
  const double speed = norm(d.first_m), speed3 = speed * speed * speed;
  const double bend = cross(d.first_m, d.second_m);
  PathPoint point;
  point.pose = {
      d.position_m[0], d.position_m[1],
      from.heading_rad + std::atan2(cross(from.tangent_m, d.first_m), dot(from.tangent_m, d.first_m))};
  point.curvature_per_m = bend / speed3;
  point.curvature_slope_per_m2 = (cross(d.first_m, d.third_m) / speed3 -
                                  3 * bend * dot(d.first_m, d.second_m) / (speed3 * speed * speed)) /
                                 speed;
  return point;
}

}  // namespace joulepath
