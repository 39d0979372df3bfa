#include "planner/path/shape/free_spline.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kShortestChord_m = 1e-3;
constexpr double kShortestHandle_m = 1e-3;
constexpr double kStandstill_m = 1e-6;  ///< shorter tangents have no direction
constexpr int kCells = 16;
constexpr int kDeepest = 12;
constexpr double kCellTurn_rad = 0.3;  ///< a cell that turns less has nearly its average curvature everywhere

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

/// Whether a span bends more tightly than allowed: cells are halved until each turns only slightly.
bool too_tight(const BezierPoints& span, double from_t, double to_t, int depth) {
  const BezierDerivatives a = bezier_derivatives(span, from_t), b = bezier_derivatives(span, to_t);
  if (std::min(norm(a.first_m), norm(b.first_m)) < kStandstill_m) return true;
  const double dot = a.first_m[0] * b.first_m[0] + a.first_m[1] * b.first_m[1];
  const double cross = a.first_m[0] * b.first_m[1] - a.first_m[1] * b.first_m[0];
  const double turn_rad = std::abs(std::atan2(cross, dot));
  const double length_m = norm({b.position_m[0] - a.position_m[0], b.position_m[1] - a.position_m[1]});
  if (turn_rad <= kCellTurn_rad) return turn_rad > kTightest_per_m * length_m;
  if (depth == 0) return true;
  const double middle_t = 0.5 * (from_t + to_t);
  return too_tight(span, from_t, middle_t, depth - 1) || too_tight(span, middle_t, to_t, depth - 1);
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
    for (int cell = 0; cell < kCells; ++cell)
      if (too_tight(span, cell / double{kCells}, (cell + 1) / double{kCells}, kDeepest)) return std::nullopt;
  for (const BezierPoints& span : spans) segments.push_back(BezierSegment(span));
  return Path{{Curve(std::move(segments))}};
}

}  // namespace joulepath
