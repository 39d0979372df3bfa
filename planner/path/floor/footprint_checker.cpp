#include "planner/path/floor/footprint_checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/assert.hpp"
#include "planner/path/floor/outline_sweep.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {
namespace {

constexpr double kLookAhead_m = 0.1;  ///< beyond this slack a polygon's exact distance is not needed
constexpr double kHalfDiagonalPerHalfSide = 1.4142135623730951;

}  // namespace

FootprintChecker::FootprintChecker(const ObstacleField& field, const Footprint& footprint, double clearance_m)
    : field_(&field), polygon_m_(footprint.polygon_m), clearance_m_(clearance_m) {
  outer_m_ = inner_m_ = footprint.radius_m;
  if (polygon_m_.empty()) return;
  JOULEPATH_ASSERT(polygon_m_.size() >= 3, "a footprint polygon needs three corners");
  outer_m_ = 0;
  for (const auto& corner : polygon_m_) outer_m_ = std::max(outer_m_, std::hypot(corner[0], corner[1]));
  inner_m_ = std::max(0.0, -signed_distance_m(polygon_m_, {0, 0}));
}

double FootprintChecker::slack_m(const Pose& pose) const {
  const double need_m = outer_m_ + clearance_m_;
  const double lower_m = field_->distance_bounds_m(pose.x_m, pose.y_m).lower_m - need_m;
  if (lower_m > field_->map().resolution_m) return lower_m;
  if (!is_disc()) return polygon_slack_m(pose);
  return field_->distance_m(pose.x_m, pose.y_m) - need_m;
}

double FootprintChecker::near_slack_m(const Pose& pose) const {
  const double need_m = outer_m_ + clearance_m_;
  if (field_->distance_bounds_m(pose.x_m, pose.y_m).lower_m - need_m >= kLookAhead_m) return kLookAhead_m;
  return is_disc() ? std::min(kLookAhead_m, field_->distance_m(pose.x_m, pose.y_m) - need_m)
                   : polygon_slack_m(pose);
}

double FootprintChecker::polygon_slack_m(const Pose& pose) const {
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  const double within_m = outer_m_ + clearance_m_ + kLookAhead_m;
  double best_m = clearance_m_ + kLookAhead_m;
  double frame_rad = 0;  // of the cells' axes
  std::vector<Point2> outline;
  const auto turned = [&](double heading_rad) {
    // The outline about the axle midpoint in the axes of the cells.
    std::vector<Point2> points;
    const double rc = std::cos(pose.heading_rad - heading_rad), rs = std::sin(pose.heading_rad - heading_rad);
    for (const auto& p : polygon_m_) points.push_back({rc * p[0] - rs * p[1], rs * p[0] + rc * p[1]});
    return points;
  };
  // An outline that lies in an obstacle, all of it, crosses no rim.
  const Point2 corner{pose.x_m + c * polygon_m_[0][0] - s * polygon_m_[0][1],
                      pose.y_m + s * polygon_m_[0][0] + c * polygon_m_[0][1]};
  const bool within = field_->distance_bounds_m(corner[0], corner[1]).upper_m == 0;
  const auto cells = within ? ObstacleField::Cells::all : ObstacleField::Cells::rim;
  field_->for_blocked_cells(pose.x_m, pose.y_m, within_m, cells, [&](const ObstacleField::BlockedCell& cell) {
    const double dx = cell.x_m - pose.x_m, dy = cell.y_m - pose.y_m, half_m = cell.half_side_m;
    const double away_m = outer_m_ + half_m * kHalfDiagonalPerHalfSide + best_m;
    if (best_m > 0 && dx * dx + dy * dy >= away_m * away_m) return;
    const Point2 in_robot{c * dx + s * dy, c * dy - s * dx};
    const double center_m = signed_distance_m(polygon_m_, in_robot);
    if (center_m - half_m * kHalfDiagonalPerHalfSide >= best_m) return;
    if (outline.empty() || cell.heading_rad != frame_rad) {
      outline = turned(cell.heading_rad);
      frame_rad = cell.heading_rad;
    }
    const double fc = std::cos(frame_rad), fs = std::sin(frame_rad);
    best_m = std::min(best_m, square_distance_m(outline, {fc * dx + fs * dy, fc * dy - fs * dx}, half_m));
  });
  return best_m - clearance_m_;
}

/// Of the corners and centers of all blocked cells, the place deepest inside of the outline.
Collision FootprintChecker::polygon_collision(double s, const Pose& pose, double slack) const {
  const double c = std::cos(pose.heading_rad), sn = std::sin(pose.heading_rad);
  double least_m = std::numeric_limits<double>::infinity();
  ObstacleField::Nearest deepest;
  field_->for_blocked_cells(
      pose.x_m, pose.y_m, outer_m_ + clearance_m_, ObstacleField::Cells::all,
      [&](const ObstacleField::BlockedCell& cell) {
        const double fc = cell.half_side_m * std::cos(cell.heading_rad),
                     fs = cell.half_side_m * std::sin(cell.heading_rad);
        constexpr int kPlaces[][2] = {{0, 0}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        for (const auto& [i, k] : kPlaces) {
          const double x_m = cell.x_m + i * fc - k * fs, y_m = cell.y_m + i * fs + k * fc;
          const double dx = x_m - pose.x_m, dy = y_m - pose.y_m;
          const double distance_m = signed_distance_m(polygon_m_, {c * dx + sn * dy, c * dy - sn * dx});
          if (distance_m >= least_m) continue;
          least_m = distance_m;
          deepest = {std::max(0.0, distance_m), cell.layer, x_m, y_m};
        }
      });
  return {s, pose, std::max(-slack, clearance_m_ - least_m), deepest};
}

Collision FootprintChecker::collision_at(double s, const Pose& pose, double slack) const {
  if (!is_disc()) return polygon_collision(s, pose, slack);
  return {s, pose, -slack, field_->nearest(pose.x_m, pose.y_m)};
}

Pose FootprintChecker::pose_on(const PathPiece& piece, double s) const {
  const auto* curve = std::get_if<Curve>(&piece);
  return curve ? pose_on(*curve, s) : piece_point(piece, s).pose;
}

std::optional<Collision> FootprintChecker::pose_collision(const Pose& pose) const {
  const double slack = slack_m(pose);
  if (slack >= -kTolerance_m) return std::nullopt;
  return collision_at(0, pose, slack);
}

template <class Place>
std::optional<Collision> FootprintChecker::first_on(double length, double reach_per_s,
                                                    const Place& place) const {
  std::optional<Collision> first;
  sweep_outline(*this, length, reach_per_s, place, [&](double s, const Pose& pose, double slack) {
    if (slack < -kTolerance_m) first = collision_at(s, pose, slack);
    return !first;
  });
  return first;
}

namespace {

/// Largest |curvature| of a segment: exact for linear curvature, sampled for Bezier curves.
double largest_curvature_per_m(const CurveSegment& segment) {
  const auto sampled = [](const auto& s, int count) {
    double largest = 0;
    for (int i = 0; i <= count; ++i)
      largest = std::max(largest, std::abs(s.bend(s.length_m() * i / count).curvature_per_m));
    return largest;
  };
  if (const auto* linear = std::get_if<LinearCurvature>(&segment)) return sampled(*linear, 1);
  if (const auto* turning = std::get_if<DirectionSegment>(&segment)) return turning->curvature_bound_per_m();
  return 1.2 * sampled(std::get<BezierSegment>(segment), 64);
}

}  // namespace

double FootprintChecker::reach_per_s(const PathPiece& piece) const {
  if (is_turn(piece)) return std::max(outer_m_, 1e-3);
  double reach = 1;
  if (!is_disc())
    for (const CurveSegment& segment : std::get<Curve>(piece).segments())
      reach = std::max(reach, 1 + outer_m_ * largest_curvature_per_m(segment));
  return reach;
}

std::optional<Collision> FootprintChecker::first_collision(const PathPiece& piece) const {
  const auto place = [this, &piece](double s) { return pose_on(piece, s); };
  if (is_turn(piece) && is_disc()) return pose_collision(place(0));
  std::optional<Collision> first = first_on(piece_length(piece), reach_per_s(piece), place);
  if (first) first->pose = piece_point(piece, first->s).pose;
  return first;
}

std::optional<Collision> FootprintChecker::first_collision(const Path& path) const {
  for (const PathPiece& piece : path.pieces)
    if (auto collision = first_collision(piece)) return collision;
  return std::nullopt;
}

bool FootprintChecker::segment_free(const CurveSegment& segment) const {
  const double reach = is_disc() ? 1 : 1 + outer_m_ * largest_curvature_per_m(segment);
  const double length_m = std::visit([](const auto& s) { return s.length_m(); }, segment);
  const auto place = [&](double s_m) {
    return std::visit([this, s_m](const auto& s) { return pose_on(s, s_m); }, segment);
  };
  return !first_on(length_m, reach, place).has_value();
}

bool FootprintChecker::line_free(double x0_m, double y0_m, double x1_m, double y1_m) const {
  const double length_m = std::hypot(x1_m - x0_m, y1_m - y0_m);
  if (length_m < 1e-12) return true;
  if (is_disc()) return disc_line_free(*field_, x0_m, y0_m, x1_m, y1_m, outer_m_ + clearance_m_);
  return segment_free(LinearCurvature({x0_m, y0_m, std::atan2(y1_m - y0_m, x1_m - x0_m)}, length_m));
}

bool disc_line_free(const ObstacleField& field, double x0_m, double y0_m, double x1_m, double y1_m,
                    double radius_m, double shortest_step_m) {
  const double length_m = std::hypot(x1_m - x0_m, y1_m - y0_m);
  const double ux = length_m > 0 ? (x1_m - x0_m) / length_m : 0,
               uy = length_m > 0 ? (y1_m - y0_m) / length_m : 0;
  for (double s_m = 0;;) {
    const double x_m = x0_m + s_m * ux, y_m = y0_m + s_m * uy;
    const auto bounds = field.distance_bounds_m(x_m, y_m);
    double slack_m = bounds.lower_m - radius_m;
    if (bounds.upper_m < radius_m - FootprintChecker::kTolerance_m) return false;
    if (slack_m < shortest_step_m) slack_m = field.distance_m(x_m, y_m) - radius_m;
    if (slack_m < -FootprintChecker::kTolerance_m) return false;
    if (s_m >= length_m) return true;
    s_m = std::min(length_m, s_m + std::max(shortest_step_m, slack_m));
  }
}

}  // namespace joulepath
