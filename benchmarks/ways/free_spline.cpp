#include "benchmarks/ways/free_spline.hpp"

#include <algorithm>
#include <cmath>

#include "planner/path/geometry/hodograph.hpp"

namespace joulepath {
namespace {

constexpr double kShortestChord_m = 1e-3;
constexpr double kShortestHandle_m = 1e-3;
constexpr double kSlowest = 0.1;  ///< least |B'|, as a share of what a span has at its ends and of its chord
constexpr int kDeepest = 16;

double norm(const Point2& v) { return std::hypot(v[0], v[1]); }

/// Derivatives at the points per unit of chord: continuity of the second derivative is one tridiagonal row
/// per inner point,
///   h_i m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_{i-1} m_{i+1} = 3 (h_i d_{i-1} + h_{i-1} d_i),
/// with chords h and slopes d.
std::vector<Point2> derivatives(const FreeSpline& spline, const std::vector<double>& chord_m) {
  const std::vector<Point2>& p = spline.points_m;
  const std::size_t last = p.size() - 1;
  std::vector<Point2> m(p.size());
  const double first = 3 * spline.start_handle_m / chord_m.front();
  const double final = 3 * spline.goal_handle_m / chord_m.back();
  m.front() = {first * std::cos(spline.start_heading_rad), first * std::sin(spline.start_heading_rad)};
  m.back() = {final * std::cos(spline.goal_heading_rad), final * std::sin(spline.goal_heading_rad)};
  std::vector<double> pivot(last);
  for (std::size_t i = 1; i < last; ++i) {
    const double before = chord_m[i - 1], after = chord_m[i];
    pivot[i] = 2 * (before + after);
    for (std::size_t k = 0; k < 2; ++k)
      m[i][k] = 3 * (after * (p[i][k] - p[i - 1][k]) / before + before * (p[i + 1][k] - p[i][k]) / after);
    const double share = i > 1 ? after / pivot[i - 1] : after;
    if (i > 1) pivot[i] -= share * chord_m[i - 2];
    for (std::size_t k = 0; k < 2; ++k) m[i][k] -= share * m[i - 1][k];
  }
  for (std::size_t i = last; i-- > 1;)
    for (std::size_t k = 0; k < 2; ++k) m[i][k] = (m[i][k] - chord_m[i - 1] * m[i + 1][k]) / pivot[i];
  return m;
}

/// Whether a span bends more tightly than allowed or nearly stands still in its parameter, which bends it at
/// one place. Parts are halved until the hull of the derivative proves that they do not, or a place does.
///   kappa = |B' x B''| / |B'|^3
bool too_tight(const BezierPoints& span, double least_m, double from_t, double to_t, int depth) {
  const Hodograph part(span, from_t, to_t);
  if (part.least_m() >= least_m && part.curvature_bound_per_m() <= kTightest_per_m) return false;
  const BezierDerivatives end = bezier_derivatives(span, to_t);
  const double end_m = norm(end.first_m);
  if (depth == 0 || end_m < least_m ||
      std::abs(end.first_m[0] * end.second_m[1] - end.first_m[1] * end.second_m[0]) >
          kTightest_per_m * end_m * end_m * end_m)
    return true;
  const double middle_t = 0.5 * (from_t + to_t);
  return too_tight(span, least_m, from_t, middle_t, depth - 1) ||
         too_tight(span, least_m, middle_t, to_t, depth - 1);
}

/// |B'| may not fall far below its values at the ends and the chord.
double least_derivative_m(const BezierPoints& span) {
  const double start_m = 3 * norm({span[1][0] - span[0][0], span[1][1] - span[0][1]}),
               goal_m = 3 * norm({span[3][0] - span[2][0], span[3][1] - span[2][1]}),
               chord_m = norm({span[3][0] - span[0][0], span[3][1] - span[0][1]});
  return kSlowest * std::min({start_m, goal_m, chord_m});
}

}  // namespace

std::vector<BezierPoints> spline_spans(const FreeSpline& spline) {
  const std::vector<Point2>& p = spline.points_m;
  std::vector<double> chord_m;
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    chord_m.push_back(norm({p[i + 1][0] - p[i][0], p[i + 1][1] - p[i][1]}));
  const std::vector<Point2> m = derivatives(spline, chord_m);
  std::vector<BezierPoints> spans;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const double third_m = chord_m[i] / 3;
    BezierPoints& span = spans.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) {
      span[0][k] = p[i][k];
      span[1][k] = p[i][k] + third_m * m[i][k];
      span[2][k] = p[i + 1][k] - third_m * m[i + 1][k];
      span[3][k] = p[i + 1][k];
    }
  }
  return spans;
}

std::optional<Path> free_spline_path(const FreeSpline& spline) {
  const std::vector<Point2>& p = spline.points_m;
  if (spline.start_handle_m < kShortestHandle_m || spline.goal_handle_m < kShortestHandle_m)
    return std::nullopt;
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    if (norm({p[i + 1][0] - p[i][0], p[i + 1][1] - p[i][1]}) < kShortestChord_m) return std::nullopt;
  std::vector<CurveSegment> segments;
  const std::vector<BezierPoints> spans = spline_spans(spline);
  for (const BezierPoints& span : spans)
    if (too_tight(span, least_derivative_m(span), 0, 1, kDeepest)) return std::nullopt;
  for (const BezierPoints& span : spans) segments.push_back(BezierSegment(span));
  return Path{{Curve(std::move(segments))}};
}

}  // namespace joulepath
