#include "extensions/studio/answer/moved_path.hpp"

#include <cmath>

namespace joulepath::studio {
namespace {

constexpr double kSamePlace_m = 1e-9;
constexpr double kSameHeading_rad = 1e-9;
constexpr double kLeast_m = 1e-2;

/// z -> to + scale e^(i turn) (z - from).
struct Similarity {
  double from_x_m{}, from_y_m{}, to_x_m{}, to_y_m{};
  double scale{1.0}, turn_rad{};

  std::array<double, 2> operator()(double x_m, double y_m) const {
    const double c = scale * std::cos(turn_rad), s = scale * std::sin(turn_rad);
    const double dx_m = x_m - from_x_m, dy_m = y_m - from_y_m;
    return {to_x_m + c * dx_m - s * dy_m, to_y_m + s * dx_m + c * dy_m};
  }
  Pose operator()(const Pose& pose) const {
    const auto [x_m, y_m] = (*this)(pose.x_m, pose.y_m);
    return {x_m, y_m, pose.heading_rad + turn_rad};
  }
};

CurveSegment moved(const LinearCurvature& segment, const Similarity& to) {
  const PathPoint from = segment.at(0);
  return LinearCurvature(to(from.pose), to.scale * segment.length_m(), from.curvature_per_m / to.scale,
                         from.curvature_slope_per_m2 / (to.scale * to.scale));
}

CurveSegment moved(const BezierSegment& segment, const Similarity& to) {
  if (!segment.rational()) {
    BezierPoints points_m = segment.points_m();
    for (auto& point : points_m) point = to(point[0], point[1]);
    return BezierSegment(points_m);
  }
  RationalBezier curve = *segment.rational();
  for (auto& [x, y, weight] : curve.points) {
    const auto [x_m, y_m] = to(x / weight, y / weight);
    x = weight * x_m;
    y = weight * y_m;
  }
  return BezierSegment::rational(curve);
}

/// A larger path turns at a smaller curvature: the half track, which only scales phi, grows with it.
CurveSegment moved(const DirectionSegment& segment, const Similarity& to) {
  DirectionSegment::Shape shape = segment.shape();
  shape.length_m *= to.scale;
  shape.half_track_m *= to.scale;
  return DirectionSegment(to(segment.start()), shape);
}

PathPiece moved(const TurnInPlace& turn, const Similarity& to) {
  return TurnInPlace{to(turn.start), turn.angle_rad};
}

PathPiece moved(const Curve& curve, const Similarity& to) {
  std::vector<CurveSegment> segments;
  for (const CurveSegment& segment : curve.segments())
    segments.push_back(std::visit([&](const auto& one) { return moved(one, to); }, segment));
  return Curve(std::move(segments), curve.direction());
}

bool stays(const Path& path, const LegStart& leg_start, const Station& goal) {
  const Pose &start = leg_start.pose, from = path.start(), to = path.end();
  const auto same = [](double a_rad, double b_rad) {
    return std::abs(wrapped_angle_rad(a_rad - b_rad)) < kSameHeading_rad;
  };
  return std::hypot(from.x_m - start.x_m, from.y_m - start.y_m) < kSamePlace_m &&
         std::hypot(to.x_m - goal.x_m, to.y_m - goal.y_m) < kSamePlace_m &&
         (leg_start.heading_free || same(from.heading_rad, start.heading_rad)) &&
         (!goal.heading_rad || same(to.heading_rad, *goal.heading_rad));
}

}  // namespace

std::optional<Path> moved_path(const Path& path, const LegStart& leg_start, const Station& goal) {
  if (path.pieces.empty()) return std::nullopt;
  if (stays(path, leg_start, goal)) return path;
  const Pose& start = leg_start.pose;
  const Pose from = path.start(), end = path.end();
  const double old_x_m = end.x_m - from.x_m, old_y_m = end.y_m - from.y_m;
  const double new_x_m = goal.x_m - start.x_m, new_y_m = goal.y_m - start.y_m;
  const double old_m = std::hypot(old_x_m, old_y_m), new_m = std::hypot(new_x_m, new_y_m);
  if (old_m < kLeast_m || new_m < kLeast_m) return std::nullopt;
  const Similarity to{from.x_m,  from.y_m,      start.x_m,
                      start.y_m, new_m / old_m, std::atan2(new_y_m, new_x_m) - std::atan2(old_y_m, old_x_m)};
  std::size_t first = 0, last = path.pieces.size();
  while (first < last && is_turn(path.pieces[first])) ++first;
  while (last > first && is_turn(path.pieces[last - 1])) --last;
  if (first == last) return std::nullopt;
  Path result;
  if (!leg_start.heading_free)
    append_turn_to(result, start, to(piece_point(path.pieces[first], 0).pose).heading_rad);
  for (std::size_t k = first; k < last; ++k)
    result.pieces.push_back(std::visit([&](const auto& piece) { return moved(piece, to); }, path.pieces[k]));
  if (goal.heading_rad) append_turn_to(result, start, *goal.heading_rad);
  return result;
}

}  // namespace joulepath::studio
