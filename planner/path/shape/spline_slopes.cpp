#include "planner/path/shape/spline_slopes.hpp"

#include <array>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kStep = 1e-6;  ///< of differences: control points are smooth in the variables

double cross_m2(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }
double dot_m2(const Point2& a, const Point2& b) { return a[0] * b[0] + a[1] * b[1]; }

/// Derivatives of the cost by the control points of the spans.
class ControlSlopes {
 public:
  explicit ControlSlopes(const FreeSpline& spline)
      : spline_(spline), spans_(spline_spans(spline)), by_point_(spans_.size()) {}

  void add(std::size_t span, double t, const PlaceSlope& slope);
  void add_length(std::size_t span, double from_t, double to_t, double by_length);
  SplineSlopes by_variables() const;

 private:
  void add_first(std::size_t span, double t, const Point2& by_first);
  void add_differences(std::size_t span, const std::array<double, 3>& share, const Point2& by);
  double along(const FreeSpline& low, const FreeSpline& high) const;

  const FreeSpline& spline_;
  std::vector<BezierPoints> spans_;
  std::vector<BezierPoints> by_point_;
};

/// `share`: of the differences between neighboring control points.
void ControlSlopes::add_differences(std::size_t span, const std::array<double, 3>& share, const Point2& by) {
  BezierPoints& to = by_point_[span];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      to[i + 1][k] += share[i] * by[k];
      to[i][k] -= share[i] * by[k];
    }
}

void ControlSlopes::add_first(std::size_t span, double t, const Point2& by_first) {
  const double u = 1 - t;
  add_differences(span, {3 * u * u, 6 * u * t, 3 * t * t}, by_first);
}

/// With v = |B'|, c = B' x B'', g = B' . B'', e = B' x B''':
///   kappa = c/v^3,   d kappa/ds = e/v^4 - 3 c g/v^6,   heading = atan2(B'_y, B'_x).
void ControlSlopes::add(std::size_t span, double t, const PlaceSlope& slope) {
  const BezierDerivatives b = bezier_derivatives(spans_[span], t);
  const Point2 &d1 = b.first_m, &d2 = b.second_m, &d3 = b.third_m;
  const double v2 = dot_m2(d1, d1), v = std::sqrt(v2), c = cross_m2(d1, d2), g = dot_m2(d1, d2),
               e = cross_m2(d1, d3);
  const double k = slope.by_curvature, r = slope.by_curvature_slope;
  const double by_c = k / (v2 * v) - 3 * r * g / (v2 * v2 * v2);
  const double by_g = -3 * r * c / (v2 * v2 * v2), by_e = r / (v2 * v2);
  const double by_v =
      -3 * k * c / (v2 * v2) - 4 * r * e / (v2 * v2 * v) + 18 * r * c * g / (v2 * v2 * v2 * v);
  const double turned = slope.by_heading_rad / v2;
  const Point2 by_first{by_c * d2[1] + by_g * d2[0] + by_e * d3[1] + by_v * d1[0] / v - turned * d1[1],
                        -by_c * d2[0] + by_g * d2[1] - by_e * d3[0] + by_v * d1[1] / v + turned * d1[0]};
  const Point2 by_second{-by_c * d1[1] + by_g * d1[0], by_c * d1[0] + by_g * d1[1]};
  const Point2 by_third{-by_e * d1[1], by_e * d1[0]};
  const double u = 1 - t;
  add_first(span, t, by_first);
  add_differences(span, {-6 * u, 6 * (u - t), 6 * t}, by_second);
  add_differences(span, {6, -12, 6}, by_third);
  const std::array<double, 4> weight{u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
  for (std::size_t i = 0; i < 4; ++i) {
    by_point_[span][i][0] += weight[i] * slope.by_x_m;
    by_point_[span][i][1] += weight[i] * slope.by_y_m;
  }
}

/// The length is the integral of |B'|: three Gauss-Legendre points on a part that bends little.
void ControlSlopes::add_length(std::size_t span, double from_t, double to_t, double by_length) {
  constexpr double kAside = 0.38729833462074170, kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (int i = 0; i < 3; ++i) {
    const double t = 0.5 * (from_t + to_t) + (i - 1) * kAside * (to_t - from_t);
    const Point2 first = bezier_derivatives(spans_[span], t).first_m;
    const double share = by_length * kWeights[i] * (to_t - from_t) / std::hypot(first[0], first[1]);
    add_first(span, t, {share * first[0], share * first[1]});
  }
}

/// Change of the cost between two neighboring splines.
double ControlSlopes::along(const FreeSpline& low, const FreeSpline& high) const {
  const std::vector<BezierPoints> from = spline_spans(low), to = spline_spans(high);
  double sum = 0;
  for (std::size_t span = 0; span < spans_.size(); ++span)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 2; ++k) sum += by_point_[span][i][k] * (to[span][i][k] - from[span][i][k]);
  return sum;
}

SplineSlopes ControlSlopes::by_variables() const {
  FreeSpline low = spline_, high = spline_;
  const auto by = [&](double& in_low, double& in_high) {
    const double value = in_low;
    in_low = value - kStep;
    in_high = value + kStep;
    const double slope = along(low, high) / (2 * kStep);
    in_low = in_high = value;
    return slope;
  };
  SplineSlopes slopes{.by_start_heading_rad = by(low.start_heading_rad, high.start_heading_rad),
                      .by_start_handle_m = by(low.start_handle_m, high.start_handle_m),
                      .by_goal_heading_rad = by(low.goal_heading_rad, high.goal_heading_rad),
                      .by_goal_handle_m = by(low.goal_handle_m, high.goal_handle_m)};
  for (std::size_t i = 0; i < spline_.points_m.size(); ++i)
    slopes.by_point_m.push_back(
        {by(low.points_m[i][0], high.points_m[i][0]), by(low.points_m[i][1], high.points_m[i][1])});
  return slopes;
}

}  // namespace

SplineSlopes spline_slopes(const FreeSpline& spline, const Curve& curve, const PathSlopes& slopes) {
  ControlSlopes control(spline);
  const auto parameter = [&](std::size_t span, double s_m) {
    return std::get<BezierSegment>(curve.segments()[span]).parameter(s_m - curve.breakpoints_m()[span]);
  };
  for (const PlaceSlope& place : slopes.places) {
    const std::size_t span = curve.segment_at(place.s_m);
    control.add(span, parameter(span, place.s_m), place);
  }
  for (const LengthSlope& length : slopes.lengths) {
    const std::size_t span = curve.segment_at(0.5 * (length.from_m + length.to_m));
    control.add_length(span, parameter(span, length.from_m), parameter(span, length.to_m), length.by_length);
  }
  return control.by_variables();
}

SplineSlopes spline_slopes(const FreeSpline& spline, const PointSlope& slope) {
  ControlSlopes control(spline);
  control.add(slope.span, slope.t,
              {.by_x_m = slope.by_x_m, .by_y_m = slope.by_y_m, .by_heading_rad = slope.by_heading_rad});
  return control.by_variables();
}

}  // namespace joulepath
