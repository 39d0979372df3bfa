#include "extensions/onboard/replan/projection.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr int kNewtonSteps = 8;
constexpr double kMostStep_m = 0.25;
constexpr double kSettled_m = 1e-6;

}  // namespace

PathOffset PathProjection::look(const Pose& pose, double travelled) {
  if (is_turn(piece_)) return look_at_turn(pose);
  s_ = std::clamp(s_ + travelled, 0.0, length_);
  const int sign = travel_sign(piece_);
  PathOffset offset;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const PathPoint foot = piece_point(piece_, s_);
    const double c = std::cos(foot.pose.heading_rad), sn = std::sin(foot.pose.heading_rad);
    const double dx = pose.x_m - foot.pose.x_m, dy = pose.y_m - foot.pose.y_m;
    const double ahead = sign * (c * dx + sn * dy);
    offset = {s_, -sn * dx + c * dy, wrapped_angle_rad(pose.heading_rad - foot.pose.heading_rad)};
    // The foot moves by ahead/(1 - curvature times lateral offset), both seen along the travel.
    const double shrink = std::max(0.2, 1 - sign * foot.curvature_per_m * offset.lateral_m);
    const double next = std::clamp(s_ + std::clamp(ahead / shrink, -kMostStep_m, kMostStep_m), 0.0, length_);
    if (std::abs(next - s_) < kSettled_m) break;
    s_ = next;
  }
  return offset;
}

PathOffset PathProjection::look_at_turn(const Pose& pose) {
  const Pose start = piece_point(piece_, 0).pose;
  const double here = turn_sign(piece_) * (pose.heading_rad - start.heading_rad) - s_;
  s_ += wrapped_angle_rad(here);
  const double dx = pose.x_m - start.x_m, dy = pose.y_m - start.y_m;
  return {std::clamp(s_, 0.0, length_), std::hypot(dx, dy), 0.0};
}

}  // namespace joulepath
