#include "planner/motion/driven_pose.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>

namespace joulepath {
namespace {

namespace odeint = boost::numeric::odeint;

using PoseState = std::array<double, 3>;  // x, y, heading

/// Integrates from one breakpoint to the next; false where no step resolves the curvature.
bool drive_segment(const PathPiece& piece, double from_m, double to_m, PoseState& pose) {
  constexpr double kLeastPoseStep = 1e-12;  // of the segment
  constexpr int kFirstSteps = 8;            // of the segment: a peak between the stages of one step is unseen
  const double along = travel_sign(piece), length_m = to_m - from_m, least_m = kLeastPoseStep * length_m;
  const auto system = [&](const PoseState& x, PoseState& dx, double since_m) {
    const double curvature_per_m = piece_bend(piece, from_m + since_m).curvature_per_m;
    dx = {along * std::cos(x[2]), along * std::sin(x[2]), curvature_per_m};
  };
  auto stepper = odeint::make_controlled(1e-9, 1e-9, odeint::runge_kutta_dopri5<PoseState>());
  double step_m = length_m / kFirstSteps;
  for (double since_m = 0; length_m - since_m > least_m;) {
    step_m = std::min(step_m, length_m - since_m);
    if (!(since_m + step_m > since_m)) return false;
    if (stepper.try_step(system, pose, since_m, step_m) == odeint::fail && step_m <= least_m) return false;
  }
  return true;
}

}  // namespace

std::optional<Pose> driven_end(const PathPiece& piece) {
  if (is_turn(piece)) return piece_point(piece, piece_length(piece)).pose;
  const Pose start = piece_point(piece, 0).pose;
  PoseState pose{start.x_m, start.y_m, start.heading_rad};
  const std::vector<double> ends_m = piece_breakpoints(piece);
  for (std::size_t k = 0; k + 1 < ends_m.size(); ++k)
    if (ends_m[k + 1] > ends_m[k] && !drive_segment(piece, ends_m[k], ends_m[k + 1], pose))
      return std::nullopt;
  return Pose{pose[0], pose[1], pose[2]};
}

bool leads_to_its_end(const PathPiece& piece) {
  constexpr double kSameShare = 1e-3, kSameHeading_rad = 1e-3;
  const std::optional<Pose> driven = driven_end(piece);
  if (!driven) return false;
  const double length = piece_length(piece), joints = static_cast<double>(piece_breakpoints(piece).size());
  const Pose end = piece_point(piece, length).pose;
  return std::hypot(driven->x_m - end.x_m, driven->y_m - end.y_m) <=
             kSameShare * length + joints * Curve::kPositionTolerance_m &&
         std::abs(wrapped_angle_rad(driven->heading_rad - end.heading_rad)) <=
             kSameHeading_rad + joints * Curve::kHeadingTolerance_rad;
}

}  // namespace joulepath
