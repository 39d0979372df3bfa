#include "planner/path/shape/smoothing_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "planner/path/geometry/nurbs.hpp"
// Design: docs/decisions/0200-paths.md
namespace joulepath {
namespace {

constexpr double kLongestSpan_m = 16.0;
constexpr double kShapeSpan_m = 0.5;  ///< spans longer than this follow shape below the tolerance
constexpr double kShapeShare = 0.1;   ///< of the tolerance
constexpr double kShared = 0.5;       ///< correlation of neighboring residuals from which they count as shape
constexpr double kRoughness = 0.05;   ///< r: length, in spans, below which the penalty smooths
constexpr double kPinned = 1e6;       ///< weight of the ends
constexpr double kDirectionShape_rad = 0.0003;
constexpr int kRounds = 60;
constexpr std::size_t kOrder = 4;  // of a cubic

using Weights = std::array<double, kOrder>;

/// Chord lengths along the points.
std::vector<double> parameters(const std::vector<Point2>& points_m) {
  std::vector<double> u{0.0};
  for (std::size_t i = 1; i < points_m.size(); ++i)
    u.push_back(u.back() +
                std::hypot(points_m[i][0] - points_m[i - 1][0], points_m[i][1] - points_m[i - 1][1]));
  return u;
}

/// Cubic B-splines over spans with fourfold ends.
class Basis {
 public:
  explicit Basis(const std::vector<double>& ends) : knots_(3, ends.front()) {
    knots_.insert(knots_.end(), ends.begin(), ends.end());
    knots_.insert(knots_.end(), 3, ends.back());
  }

  std::size_t spans() const { return knots_.size() - 7; }
  std::size_t size() const { return spans() + 3; }
  const std::vector<double>& knots() const { return knots_; }
  double span_length(std::size_t span) const { return knots_[span + 4] - knots_[span + 3]; }

  /// The four functions that are not zero on a span, at u.
  Weights at(std::size_t span, double u) const { return functions(span, u, kOrder - 1); }

  /// Their first derivatives.
  Weights derivatives(std::size_t span, double u) const {
    const std::size_t k = span + 3;
    const Weights below = functions(span, u, kOrder - 2);
    Weights slopes{};
    for (std::size_t j = 0; j + 1 < kOrder; ++j) {
      const double slope = (kOrder - 1) / (knots_[k + 1 + j] - knots_[k + j - 2]) * below[j];
      slopes[j] -= slope;
      slopes[j + 1] += slope;
    }
    return slopes;
  }

  /// The functions of a degree up to 3 that are not zero on a span, by the recursion of Cox and de Boor.
  Weights functions(std::size_t span, double u, std::size_t up_to) const {
    const std::size_t k = span + 3;
    Weights n{1.0};
    for (std::size_t degree = 1; degree <= up_to; ++degree) {
      double saved = 0.0;
      for (std::size_t j = 0; j < degree; ++j) {
        const double right = knots_[k + j + 1] - u, left = u - knots_[k + j + 1 - degree];
        const double part = n[j] / (right + left);
        n[j] = saved + right * part;
        saved = left * part;
      }
      n[degree] = saved;
    }
    return n;
  }

  /// Third derivatives of the same functions: constant on a span.
  Weights third_derivatives(std::size_t span) const {
    Weights result{};
    for (std::size_t i = 0; i < kOrder; ++i) {
      Weights d{};
      d[i] = 1.0;
      for (std::size_t round = 1; round < kOrder; ++round)
        for (std::size_t j = 0; j + round < kOrder; ++j) {
          const std::size_t first = span + j + round;
          d[j] = static_cast<double>(kOrder - round) * (d[j + 1] - d[j]) /
                 (knots_[first + kOrder - round] - knots_[first]);
        }
      result[i] = d[0];
    }
    return result;
  }

 private:
  std::vector<double> knots_;
};

/// Normal equations of the least squares: four diagonals, with a right side per axis.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t size) : band_(size), right_(size) {}

  void add(std::size_t first, const Weights& a, double weight, const Point2& value) {
    for (std::size_t i = 0; i < kOrder; ++i) {
      for (std::size_t j = 0; j <= i; ++j) band_[first + i][i - j] += weight * a[i] * a[j];
      for (std::size_t axis = 0; axis < 2; ++axis) right_[first + i][axis] += weight * a[i] * value[axis];
    }
  }

  /// Solves by Cholesky factorization, in place.
  std::vector<Point2> solved() && {
    const std::size_t n = band_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t reach = std::min(i, kOrder - 1);
      for (std::size_t back = reach + 1; back-- > 0;) {
        const std::size_t j = i - back;
        double sum = band_[i][back];
        for (std::size_t k = i - reach; k < j; ++k)
          if (j - k < kOrder) sum -= band_[i][i - k] * band_[j][j - k];
        band_[i][back] = back > 0 ? sum / band_[j][0] : std::sqrt(sum);
      }
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t back = 1; back <= std::min(i, kOrder - 1); ++back)
          right_[i][axis] -= band_[i][back] * right_[i - back][axis];
        right_[i][axis] /= band_[i][0];
      }
      for (std::size_t i = n; i-- > 0;) {
        for (std::size_t ahead = 1; ahead < kOrder && i + ahead < n; ++ahead)
          right_[i][axis] -= band_[i + ahead][ahead] * right_[i + ahead][axis];
        right_[i][axis] /= band_[i][0];
      }
    }
    return std::move(right_);
  }

 private:
  std::vector<std::array<double, kOrder>> band_;  ///< [i][k]: entry (i, i - k)
  std::vector<Point2> right_;
};

/// A fit over spans whose ends are among the points.
class Fit {
 public:
  Fit(const std::vector<Point2>& points_m, const std::vector<Point2>& directions,
      const std::vector<double>& u, const std::vector<std::size_t>& ends)
      : points_(points_m), directions_(directions), u_(u), ends_(ends), basis_(values_at(ends)) {
    NormalEquations equations(basis_.size());
    for (std::size_t span = 0; span < basis_.spans(); ++span) {
      for_points_of(span, [&](std::size_t i) {
        const bool end = i == 0 || i + 1 == points_.size();
        const double weight = end ? kPinned * u_.back() : 0.5 * (u_[i + 1] - u_[i - 1]);
        equations.add(span, basis_.at(span, u_[i]), weight, points_[i]);
        if (!directions_.empty())
          equations.add(span, basis_.derivatives(span, u_[i]), weight, directions_[i]);
      });
      const double h = basis_.span_length(span);
      equations.add(span, basis_.third_derivatives(span), std::pow(kRoughness * h, 6) * h, {0.0, 0.0});
    }
    control_ = std::move(equations).solved();
    control_.front() = points_.front();
    control_.back() = points_.back();
    if (directions_.empty()) return;
    put_on_line(control_[1], control_.front(), directions_.front());
    put_on_line(control_[control_.size() - 2], control_.back(), directions_.back());
  }

  /// The spans, halved where they miss the tolerance; unchanged ends if none does.
  std::vector<std::size_t> halved(double tolerance_m) {
    const std::size_t spans = basis_.spans();
    std::vector<bool> cut(spans);
    for (std::size_t span = 0; span < spans; ++span) {
      if (!misses(span, tolerance_m)) continue;
      cut[span] = true;
      if (ends_[span + 1] > ends_[span] + 1) continue;
      // A span of one chord cannot be cut; the spans around it are cut instead.
      for (std::size_t near = span - std::min(span, kOrder); near < std::min(spans, span + 1 + kOrder);
           ++near)
        cut[near] = true;
    }
    std::vector<std::size_t> ends{0};
    for (std::size_t span = 0; span < spans; ++span) {
      const std::size_t from = ends_[span], to = ends_[span + 1];
      if (cut[span] && to > from + 1) ends.push_back(middle_of(from, to));
      ends.push_back(to);
    }
    return ends;
  }

  SmoothingSpline spline() const {
    SmoothingSpline result;
    Nurbs nurbs{.degree = 3, .knots = basis_.knots()};
    for (const Point2& c : control_) nurbs.points.push_back({c[0], c[1], 1.0});
    for (const RationalBezier& piece : bezier_pieces(nurbs)) {
      BezierPoints curve;
      for (std::size_t k = 0; k < curve.size(); ++k) curve[k] = piece.place_m(k);
      result.curves_m.push_back(curve);
    }
    for (std::size_t span = 0; span < basis_.spans(); ++span)
      for_points_of(span, [&](std::size_t i) {
        const Point2 off = residual(span, i);
        const double off_m = std::hypot(off[0], off[1]);
        if (off_m > result.deviation_m) result.deviation_m = off_m, result.worst = i;
      });
    return result;
  }

 private:
  std::vector<double> values_at(const std::vector<std::size_t>& ends) const {
    std::vector<double> values;
    for (const std::size_t i : ends) values.push_back(u_[i]);
    return values;
  }

  static void put_on_line(Point2& point, const Point2& through, const Point2& direction) {
    const double along = (point[0] - through[0]) * direction[0] + (point[1] - through[1]) * direction[1];
    for (std::size_t axis = 0; axis < 2; ++axis) point[axis] = through[axis] + along * direction[axis];
  }

  template <class Visit>
  void for_points_of(std::size_t span, const Visit& visit) const {
    const bool last = span + 1 == basis_.spans();
    for (std::size_t i = ends_[span]; i < ends_[span + 1] + (last ? 1 : 0); ++i) visit(i);
  }

  Point2 residual(std::size_t span, std::size_t i) const {
    const Weights n = basis_.at(span, u_[i]);
    Point2 off = points_[i];
    for (std::size_t k = 0; k < kOrder; ++k)
      for (std::size_t axis = 0; axis < 2; ++axis) off[axis] -= n[k] * control_[span + k][axis];
    return off;
  }

  /// Angle from the given direction at a point to the spline's, as its sine.
  double turned_off(std::size_t span, std::size_t i) const {
    const Weights n = basis_.derivatives(span, u_[i]);
    Point2 slope{};
    for (std::size_t k = 0; k < kOrder; ++k)
      for (std::size_t axis = 0; axis < 2; ++axis) slope[axis] += n[k] * control_[span + k][axis];
    return (directions_[i][0] * slope[1] - directions_[i][1] * slope[0]) / std::hypot(slope[0], slope[1]);
  }

  bool misses_direction(std::size_t span) const {
    if (directions_.empty()) return false;
    double largest = 0, squares = 0, products = 0, before = 0;
    for_points_of(span, [&](std::size_t i) {
      const double off = turned_off(span, i);
      largest = std::max(largest, std::abs(off));
      squares += off * off;
      products += off * std::exchange(before, off);
    });
    return largest > kDirectionShape_rad && products > kShared * squares;
  }

  bool misses(std::size_t span, double tolerance_m) const {
    if (misses_direction(span)) return true;
    double largest2 = 0, squares = 0, products = 0;
    Point2 before{};
    for_points_of(span, [&](std::size_t i) {
      const Point2 off = residual(span, i);
      largest2 = std::max(largest2, off[0] * off[0] + off[1] * off[1]);
      squares += off[0] * off[0] + off[1] * off[1];
      products += off[0] * before[0] + off[1] * before[1];
      before = off;
    });
    const double largest_m = std::sqrt(largest2);
    if (largest_m > tolerance_m) return true;
    return basis_.span_length(span) > kShapeSpan_m && largest_m > kShapeShare * tolerance_m &&
           products > kShared * squares;
  }

  /// The point between two points that is nearest to the middle of the curve between them.
  std::size_t middle_of(std::size_t from, std::size_t to) const {
    const auto first = u_.begin() + static_cast<std::ptrdiff_t>(from);
    const auto at =
        std::lower_bound(first, u_.begin() + static_cast<std::ptrdiff_t>(to), 0.5 * (u_[from] + u_[to]));
    return std::clamp(from + static_cast<std::size_t>(at - first), from + 1, to - 1);
  }

  const std::vector<Point2>&points_, &directions_;
  const std::vector<double>& u_;
  const std::vector<std::size_t>& ends_;
  Basis basis_;
  std::vector<Point2> control_{};
};

std::vector<std::size_t> first_ends(const std::vector<double>& u) {
  std::vector<std::size_t> ends{0};
  for (std::size_t i = 1; i + 1 < u.size(); ++i)
    if (u[i] - u[ends.back()] >= kLongestSpan_m) ends.push_back(i);
  ends.push_back(u.size() - 1);
  return ends;
}

}  // namespace

SmoothingSpline smoothing_spline(const std::vector<Point2>& points_m, double tolerance_m,
                                 const std::vector<Point2>& directions) {
  const std::vector<double> u = parameters(points_m);
  std::vector<std::size_t> ends = first_ends(u);
  for (int round = 0; round < kRounds; ++round) {
    Fit fit(points_m, directions, u, ends);
    std::vector<std::size_t> finer = fit.halved(tolerance_m);
    if (finer.size() == ends.size()) return fit.spline();
    ends = std::move(finer);
  }
  return Fit(points_m, directions, u, ends).spline();
}

}  // namespace joulepath
