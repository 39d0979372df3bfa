#include "planner/path/geometry/bezier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/assert.hpp"
#include "planner/path/geometry/hodograph.hpp"

namespace joulepath {
namespace {

using Vector = std::array<double, 2>;

Vector combine(double a, const Vector& u, double b, const Vector& v) {
  return {a * u[0] + b * v[0], a * u[1] + b * v[1]};
}
double cross(const Vector& u, const Vector& v) { return u[0] * v[1] - u[1] * v[0]; }
double dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1]; }
double norm(const Vector& u) { return std::sqrt(dot(u, u)); }
/// kappa = B' x B'' / |B'|^3 and its derivative by the arc length.
PathBend bend_of(const BezierDerivatives& d) {
  const double speed = norm(d.first_m), speed3 = speed * speed * speed;
  const double bend = cross(d.first_m, d.second_m);
  return {bend / speed3, (cross(d.first_m, d.third_m) / speed3 -
                          3 * bend * dot(d.first_m, d.second_m) / (speed3 * speed * speed)) /
                             speed};
}

double turn_rad(const Vector& from, const Vector& to) { return std::atan2(cross(from, to), dot(from, to)); }

constexpr int kFirstIntervals = 4;
constexpr int kDeepest = 40;
constexpr double kPartTurn_rad = 1.0;
constexpr double kTolerance = 1e-13;        // of the control polygon's length
constexpr double kExamined[] = {0.3, 0.8};  // shares of a part's length

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
    velocity_coefficients_m_[axis] = {3 * d0, 6 * (d1 - d0), 3 * (d0 - 2 * d1 + d2)};
  }
  tabulate();
}

double BezierSegment::curvature_bound_per_m() const {
  constexpr int kParts = 4;
  if (rational_) return std::numeric_limits<double>::infinity();
  double most_per_m = 0;
  for (int i = 0; i < kParts; ++i)
    most_per_m = std::max(
        most_per_m, Hodograph(points_m_, static_cast<double>(i) / kParts, static_cast<double>(i + 1) / kParts)
                        .curvature_bound_per_m());
  return most_per_m;
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
  for (int i = 0; i < kFirstIntervals; ++i)
    refine(static_cast<double>(i) / kFirstIntervals, static_cast<double>(i + 1) / kFirstIntervals, 0);
}

Vector BezierSegment::velocity_m(double t) const {
  if (rational_) return derivatives(t).first_m;
  const auto along = [t](const std::array<double, 3>& c) { return c[0] + t * (c[1] + t * c[2]); };
  return {along(velocity_coefficients_m_[0]), along(velocity_coefficients_m_[1])};
}

/// Appends a part that does not turn far and on which t(s) solves dt/ds = 1 / |B'|, else its halves.
void BezierSegment::refine(double from_t, double to_t, int depth) {
  const double middle_t = 0.5 * (from_t + to_t);
  const Vector from = velocity_m(from_t), middle = velocity_m(middle_t), to = velocity_m(to_t);
  const double turned_rad = std::abs(turn_rad(from, middle)) + std::abs(turn_rad(middle, to));
  if (turned_rad <= kPartTurn_rad || depth >= kDeepest) {
    const ArcCell cell([this](double t) { return norm(velocity_m(t)); }, from_t, to_t);
    const auto error_m = [&](double share) {
      const ArcCell::Place place = cell.place(share * cell.length_m());
      return cell.length_m() * std::abs(place.t_per_m * norm(velocity_m(place.t)) - 1);
    };
    const bool exact = std::max(error_m(kExamined[0]), error_m(kExamined[1])) <= kTolerance * scale_m_;
    if (exact || depth >= kDeepest) return append(cell, from);
  }
  refine(from_t, middle_t, depth + 1);
  refine(middle_t, to_t, depth + 1);
}

void BezierSegment::append(const ArcCell& cell, const Vector& tangent_m) {
  const double heading_rad = parts_.empty()
                                 ? std::atan2(tangent_m[1], tangent_m[0])
                                 : parts_.back().heading_rad + turn_rad(parts_.back().tangent_m, tangent_m);
  parts_.push_back({length_m_, heading_rad, tangent_m, cell});
  length_m_ += cell.length_m();
}

const BezierSegment::Part& BezierSegment::part_at(double s_m) const {
  const auto after = std::upper_bound(parts_.begin() + 1, parts_.end(), s_m,
                                      [](double s, const Part& part) { return s < part.s_m; });
  return *(after - 1);
}

double BezierSegment::parameter(double s_m) const {
  const Part& part = part_at(s_m);
  return part.cell.parameter(s_m - part.s_m);
}

PathPoint BezierSegment::at(double s_m) const {
  const Part& part = part_at(s_m);
  const BezierDerivatives d = derivatives(part.cell.parameter(s_m - part.s_m));
  const PathBend bend = bend_of(d);
  return {{d.position_m[0], d.position_m[1], part.heading_rad + turn_rad(part.tangent_m, d.first_m)},
          bend.curvature_per_m,
          bend.curvature_slope_per_m2};
}

PathBend BezierSegment::bend(double s_m) const {
  const double t = parameter(s_m);
  if (rational_) return bend_of(derivatives(t));
  BezierDerivatives d{.first_m = velocity_m(t)};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& c = velocity_coefficients_m_[axis];
    d.second_m[axis] = c[1] + 2 * t * c[2];
    d.third_m[axis] = 2 * c[2];
  }
  return bend_of(d);
}

}  // namespace joulepath
