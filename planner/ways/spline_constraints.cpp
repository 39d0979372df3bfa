#include "planner/ways/spline_constraints.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kPart_m = 0.8;        ///< length of the parts that each have a constraint of clearance
constexpr std::size_t kMostParts = 6;  ///< per span
constexpr double kSlackStep_m = 0.03;
constexpr double kTrust = 0.7;        ///< share of the excess of slack that a step may take
constexpr double kStep_m = 1e-4;      ///< of differences of the clearance
constexpr double kTightShare = 0.98;  ///< of the tightest curvature that a search aims for
constexpr double kWide = -3;          ///< least logarithm of a bend that counts
constexpr int kLooks = 16;            ///< places of a span that are looked at

double curvature_of(const BezierPoints& span, double t) {
  const BezierDerivatives b = bezier_derivatives(span, t);
  const double speed = std::max(std::hypot(b.first_m[0], b.first_m[1]), 1e-9);
  return (b.first_m[0] * b.second_m[1] - b.first_m[1] * b.second_m[0]) / (speed * speed * speed);
}

/// How far a span's curvature is above the tightest one, in logarithms; spans that bend much less count as
/// kWide. Steps that know of the bound do not end in splines that are none (free_spline.hpp).
ConstraintRow bend(const BezierPoints& points_m, std::size_t spline, std::size_t span) {
  double tightest = 0, at = 0;
  for (int i = 0; i <= kLooks; ++i) {
    const double t = static_cast<double>(i) / kLooks;
    const double curvature = curvature_of(points_m, t);
    if (std::abs(curvature) > std::abs(tightest)) tightest = curvature, at = t;
  }
  ConstraintRow row{std::max(kWide, std::log(std::abs(tightest) / (kTightShare * kTightest_per_m))), spline};
  if (row.value > kWide) row.slope = PointSlope{.span = span, .t = at, .by_curvature = 1 / tightest};
  return row;
}

}  // namespace

SplineConstraints::SplineConstraints(const FootprintChecker& checker, const std::vector<Path>& first)
    : checker_(checker) {
  for (std::size_t spline = 0; spline < first.size(); ++spline) {
    const std::vector<double>& ends_m = std::get<Curve>(first[spline].pieces.front()).breakpoints_m();
    spans_ += ends_m.size() - 1;
    for (std::size_t span = 0; span + 1 < ends_m.size(); ++span) {
      const double length_m = ends_m[span + 1] - ends_m[span];
      const auto count =
          std::clamp(static_cast<std::size_t>(std::ceil(length_m / kPart_m)), std::size_t{1}, kMostParts);
      for (std::size_t i = 0; i < count; ++i)
        parts_.push_back({spline, span, static_cast<double>(i) / static_cast<double>(count),
                          static_cast<double>(i + 1) / static_cast<double>(count)});
    }
  }
}

std::vector<ConstraintRow> SplineConstraints::at(const std::vector<FreeSpline>& splines,
                                                 const std::vector<Path>& paths, bool with_slopes) const {
  std::vector<ConstraintRow> rows;
  for (const Part& part : parts_) {
    const Curve& curve = std::get<Curve>(paths[part.spline].pieces.front());
    const Nearest nearest = nearest_on(part, curve);
    ConstraintRow& row = rows.emplace_back(ConstraintRow{kClearanceMargin_m - nearest.slack_m, part.spline});
    if (!with_slopes) continue;
    const PointSlope slope = margin_slope(part, curve, nearest.s_m);
    if (slope.by_x_m != 0 || slope.by_y_m != 0 || slope.by_heading_rad != 0) row.slope = slope;
  }
  for (std::size_t k = 0; k < splines.size(); ++k) {
    const std::vector<BezierPoints> spans = spline_spans(splines[k]);
    for (std::size_t span = 0; span < spans.size(); ++span) rows.push_back(bend(spans[span], k, span));
  }
  return rows;
}

/// The place with the least slack on a part of a path.
SplineConstraints::Nearest SplineConstraints::nearest_on(const Part& part, const Curve& curve) const {
  const double s0_m = curve.breakpoints_m()[part.span],
               length_m = curve.breakpoints_m()[part.span + 1] - s0_m;
  const double end_m = s0_m + part.to * length_m;
  Nearest nearest{.slack_m = kNoLimit};
  for (double s_m = s0_m + part.from * length_m;;) {
    const double slack_m = checker_.near_slack_m(checker_.pose_on(curve, s_m));
    if (slack_m < nearest.slack_m) nearest = {slack_m, s_m};
    if (s_m >= end_m) return nearest;
    s_m = std::min(end_m, s_m + std::max(kSlackStep_m, kTrust * (slack_m - nearest.slack_m)));
  }
}

/// Derivatives of the margin less the slack at a place.
PointSlope SplineConstraints::margin_slope(const Part& part, const Curve& curve, double s_m) const {
  const Pose pose = curve.at(s_m).pose;
  const auto by = [&](double dx_m, double dy_m, double turn_rad) {
    const auto slack_at = [&](double step_m) {
      return checker_.near_slack_m(
          {pose.x_m + step_m * dx_m, pose.y_m + step_m * dy_m, pose.heading_rad + step_m * turn_rad});
    };
    return (slack_at(-kStep_m) - slack_at(kStep_m)) / (2 * kStep_m);
  };
  const auto& segment = std::get<BezierSegment>(curve.segments()[part.span]);
  const double along_m = std::clamp(s_m - curve.breakpoints_m()[part.span], 0.0, segment.length_m());
  return {.span = part.span,
          .t = segment.parameter(along_m),
          .by_x_m = by(1, 0, 0),
          .by_y_m = by(0, 1, 0),
          .by_heading_rad = checker_.is_disc() ? 0.0 : by(0, 0, 1)};
}

}  // namespace joulepath
