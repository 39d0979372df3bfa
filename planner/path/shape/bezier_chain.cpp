#include "planner/path/shape/bezier_chain.hpp"

#include <cmath>
#include <cstdio>
#include <iterator>

#include "planner/path/geometry/bezier_geometry.hpp"
#include "planner/path/geometry/rounding.hpp"
#include "planner/path/geometry/segment_ends.hpp"

namespace joulepath {
namespace {

using Kind = BezierFinding::Kind;

BezierPoints in_map_frame(const BezierPoints& points_m, const Pose& start) {
  const double c = std::cos(start.heading_rad), s = std::sin(start.heading_rad);
  BezierPoints out;
  for (std::size_t i = 0; i < points_m.size(); ++i)
    out[i] = {start.x_m + c * points_m[i][0] - s * points_m[i][1],
              start.y_m + s * points_m[i][0] + c * points_m[i][1]};
  return out;
}

BezierFinding joint_finding(Kind kind, std::size_t curve, const Pose& at, double amount, const char* format) {
  char text[256];
  std::snprintf(text, sizeof text, format, curve, at.x_m, at.y_m, amount);
  return {kind, curve, 0, at.x_m, at.y_m, amount, text};
}

CurveSegment segment_of(const BezierPoints& p) {
  if (!on_a_line(p)) return BezierSegment(p);
  const double x = p[3][0] - p[0][0], y = p[3][1] - p[0][1];
  return LinearCurvature({p[0][0], p[0][1], std::atan2(y, x)}, std::hypot(x, y));
}

/// Rotates the curve's beginning by a small angle about p0.
void rotate_first_handle(BezierPoints& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double x = p[1][0] - p[0][0], y = p[1][1] - p[0][1];
  p[1] = {p[0][0] + c * x - s * y, p[0][1] + s * x + c * y};
}

/// Collects segments into curves; ends a curve at each stop of the robot.
struct ChainBuilder {
  BezierChainResult result{};
  std::vector<CurveSegment> open{};

  void close() {
    if (open.empty()) return;
    result.path.pieces.push_back(Curve(std::move(open)));
    open.clear();
  }

  void join(const Pose& start, std::size_t curve, BezierPoints points_m) {
    const PathPoint before = open.empty() ? PathPoint{start, 0, 0} : end_of(open.back());
    points_m[0] = {before.pose.x_m, before.pose.y_m};
    CurveSegment next = segment_of(points_m);
    const double step_rad = wrapped_angle_rad(begin_of(next).pose.heading_rad - before.pose.heading_rad);
    const bool rounding = std::abs(step_rad) <= kRounding_rad;
    if (rounding && (!on_a_line(points_m) || std::abs(step_rad) > Curve::kHeadingTolerance_rad)) {
      rotate_first_handle(points_m, -step_rad);
      if (bezier_defects(points_m, curve).empty()) next = segment_of(points_m);
    }
    const PathPoint after = begin_of(next);
    const double rest_rad = wrapped_angle_rad(after.pose.heading_rad - before.pose.heading_rad);
    if (std::abs(rest_rad) > Curve::kHeadingTolerance_rad) {
      if (!open.empty())
        result.notes.push_back(
            joint_finding(Kind::heading_step, curve, before.pose, rest_rad,
                          "curve %zu at (%.4g, %.4g) m: heading breaks by %.4g rad, turn in place"));
      close();
      append_turn_to(result.path, before.pose, after.pose.heading_rad);
    } else if (!open.empty()) {
      const double step_per_m = after.curvature_per_m - before.curvature_per_m;
      if (std::abs(step_per_m) > Curve::kCurvatureTolerance_per_m) {
        result.notes.push_back(
            joint_finding(Kind::curvature_step, curve, before.pose, step_per_m,
                          "curve %zu at (%.4g, %.4g) m: curvature jumps by %.4g 1/m, stop"));
        close();
      }
    }
    open.push_back(std::move(next));
  }
};

}  // namespace

BezierChainResult bezier_chain(const std::vector<BezierPoints>& curves_m, const Pose& start,
                               BezierFrame frame) {
  ChainBuilder builder;
  Pose here = start;
  std::vector<BezierPoints> points;
  for (std::size_t i = 0; i < curves_m.size(); ++i) {
    points.push_back(frame == BezierFrame::start ? in_map_frame(curves_m[i], start) : curves_m[i]);
    const BezierPoints& p = points.back();
    auto defects = bezier_defects(p, i);
    std::move(defects.begin(), defects.end(), std::back_inserter(builder.result.defects));
    const double gap_m = std::hypot(p[0][0] - here.x_m, p[0][1] - here.y_m);
    if (gap_m > kRounding_m)
      builder.result.defects.push_back(joint_finding(
          Kind::gap, i, here, gap_m, "curve %zu should begin at (%.4g, %.4g) m, it is %.4g m off"));
    here = {p[3][0], p[3][1], 0};
  }
  if (!builder.result.ok()) return builder.result;
  for (std::size_t i = 0; i < points.size(); ++i) builder.join(start, i, points[i]);
  builder.close();
  return builder.result;
}

}  // namespace joulepath
