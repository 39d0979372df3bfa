#include "planner/path/shape/spline_slopes.hpp"

#include <array>
#include <cmath>

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {
namespace {

double cross_m2(const Point2& a, const Point2& b) { return a[0] * b[1] - a[1] * b[0]; }
double dot_m2(const Point2& a, const Point2& b) { return a[0] * b[0] + a[1] * b[1]; }

/// Derivatives of the cost by a spline's points, by its derivatives m at them per unit of chord, and by its
/// chords, each with the others kept.
struct Adjoint {
  std::vector<Point2> point{}, derivative{};
  std::vector<Point2> m{};
  std::vector<double> chord{}, chord_m{};

  void through_rows(const std::vector<Point2>& p);
};

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
  Adjoint by_points() const;

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

/// From the control points to the points, chords and derivatives m of the spline: a span is
/// p, p + h m/3, p' - h m'/3, p'.
Adjoint ControlSlopes::by_points() const {
  const std::size_t last = spans_.size();
  Adjoint by{.point = std::vector<Point2>(last + 1),
             .derivative = std::vector<Point2>(last + 1),
             .m = std::vector<Point2>(last + 1),
             .chord = std::vector<double>(last),
             .chord_m = std::vector<double>(last)};
  for (std::size_t i = 0; i < last; ++i) {
    const BezierPoints &span = spans_[i], &by_span = by_point_[i];
    const double h = distance_m(span[0], span[3]);
    by.chord_m[i] = h;
    for (std::size_t k = 0; k < 2; ++k) {
      by.m[i][k] = 3 * (span[1][k] - span[0][k]) / h;
      by.m[i + 1][k] = 3 * (span[3][k] - span[2][k]) / h;
      by.point[i][k] += by_span[0][k] + by_span[1][k];
      by.point[i + 1][k] += by_span[2][k] + by_span[3][k];
      by.derivative[i][k] += h / 3 * by_span[1][k];
      by.derivative[i + 1][k] -= h / 3 * by_span[2][k];
      by.chord[i] += (by_span[1][k] * by.m[i][k] - by_span[2][k] * by.m[i + 1][k]) / 3;
    }
  }
  return by;
}

/// Through the tridiagonal rows of the spline (free_spline.cpp) by their transpose:
///   h_i m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_{i-1} m_{i+1} = 3 (h_i d_{i-1} + h_{i-1} d_i).
void Adjoint::through_rows(const std::vector<Point2>& p) {
  const std::size_t last = chord_m.size();
  const std::vector<double>& h = chord_m;
  std::vector<double> pivot(last);
  std::vector<Point2> weight = derivative;
  for (std::size_t i = 1; i < last; ++i) {
    pivot[i] = 2 * (h[i - 1] + h[i]);
    if (i == 1) continue;
    const double share = h[i - 2] / pivot[i - 1];
    pivot[i] -= share * h[i];
    for (std::size_t k = 0; k < 2; ++k) weight[i][k] -= share * weight[i - 1][k];
  }
  for (std::size_t i = last; i-- > 1;)
    for (std::size_t k = 0; k < 2; ++k) {
      if (i + 1 < last) weight[i][k] -= h[i + 1] * weight[i + 1][k];
      const double w = weight[i][k] /= pivot[i];
      const double before = h[i - 1], after = h[i];
      const double in = (p[i][k] - p[i - 1][k]) / before, out = (p[i + 1][k] - p[i][k]) / after;
      point[i - 1][k] -= w * 3 * after / before;
      point[i][k] += w * 3 * (after / before - before / after);
      point[i + 1][k] += w * 3 * before / after;
      chord[i] -= w * (m[i - 1][k] + 2 * m[i][k] - 3 * in + 3 * before / after * out);
      chord[i - 1] -= w * (2 * m[i][k] + m[i + 1][k] + 3 * after / before * in - 3 * out);
      if (i == 1) derivative.front()[k] -= after * w;
      if (i + 1 == last) derivative.back()[k] -= before * w;
    }
}

SplineSlopes ControlSlopes::by_variables() const {
  const std::vector<Point2>& p = spline_.points_m;
  Adjoint by = by_points();
  by.through_rows(p);
  SplineSlopes slopes;
  // m = 3 handle / chord along the heading
  const auto end = [](const Point2& by_m, double heading_rad, double handle_m, double chord_m,
                      double& by_heading, double& by_handle, double& by_chord) {
    const double c = 3 / chord_m * std::cos(heading_rad), s = 3 / chord_m * std::sin(heading_rad);
    by_heading = handle_m * (by_m[1] * c - by_m[0] * s);
    by_handle = by_m[0] * c + by_m[1] * s;
    by_chord -= by_handle * handle_m / chord_m;
  };
  end(by.derivative.front(), spline_.start_heading_rad, spline_.start_handle_m, by.chord_m.front(),
      slopes.by_start_heading_rad, slopes.by_start_handle_m, by.chord.front());
  end(by.derivative.back(), spline_.goal_heading_rad, spline_.goal_handle_m, by.chord_m.back(),
      slopes.by_goal_heading_rad, slopes.by_goal_handle_m, by.chord.back());
  slopes.by_point_m = std::move(by.point);
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      const double part = by.chord[i] * (p[i + 1][k] - p[i][k]) / by.chord_m[i];
      slopes.by_point_m[i + 1][k] += part;
      slopes.by_point_m[i][k] -= part;
    }
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
              {.by_curvature = slope.by_curvature,
               .by_x_m = slope.by_x_m,
               .by_y_m = slope.by_y_m,
               .by_heading_rad = slope.by_heading_rad});
  return control.by_variables();
}

}  // namespace joulepath
