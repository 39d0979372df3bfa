#include "planner/joint/start_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/joint/path_geometry.hpp"

namespace joulepath::joint {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kPhiEase = 0.2, kLeastPhiEase = 1e-4, kLeastLengthEase_m2 = 1e-4, kHeld = 1e-14;
constexpr double kMostPhiStep_rad = 0.6, kMostShrink = 0.7;
constexpr double kGoal_m = 0.01;    ///< a deviation that weighs as much as a step of the ease
constexpr double kWaypoint = 0.05;  ///< the same of waypoints (m, rad)
constexpr double kClose = 0.02;     ///< of every waypoint (m, rad): near enough
constexpr int kFollowSteps = 20;
constexpr double kMoreDamping = 4, kMostDamping = 1e4;
constexpr double kNotableGain = 0.01;  ///< of the squared deviation

/// How far each parameter moves, squared: a knot no farther than to its bound, a length no farther than to 0.
/// Those of turns in place hardly move, move() holds them.
VectorXd ease_of(const Program& program, const VectorXd& p) {
  VectorXd ease(p.size());
  for (Index i = program.knots; i < p.size(); ++i) ease[i] = std::max(kLeastLengthEase_m2, p[i] * p[i]);
  for (const Piece& piece : program.pieces)
    for (const Index knot : {piece.from, piece.to}) {
      const double room = program.most_direction_rad - std::abs(p[knot] - piece.straight_rad());
      ease[knot] = piece.turns ? kHeld : std::clamp(room * room, kLeastPhiEase, kPhiEase);
    }
  return ease;
}

/// Moves as far along a change as knots and lengths allow.
void move(const Program& program, VectorXd& p, const VectorXd& change) {
  double share = 1;
  for (Index i = 0; i < p.size(); ++i) {
    if (i < program.knots)
      share = std::min(share, kMostPhiStep_rad / std::abs(change[i]));
    else if (change[i] < 0)
      share = std::min(share, kMostShrink * (p[i] - program.least_length_m(i)) / -change[i]);
  }
  const VectorXd before = p;
  p += share * change;
  for (const Index knot : program.held()) p[knot] = before[knot];
  for (const Piece& piece : program.pieces)
    for (const Index knot : {piece.from, piece.to}) {
      if (piece.turns) continue;
      const double about = piece.straight_rad(), most = program.most_direction_rad - 1e-6;
      p[knot] = std::clamp(p[knot], about - most, about + most);
    }
}

/// Of waypoints and targets, each over the deviation that weighs as much as a step of the ease.
struct Deviations {
  VectorXd weighted;
  MatrixXd slopes;  ///< [deviations x parameters]
  bool are_close;
};

Deviations deviations_of(const Program& program, PathGeometry& geometry, const VectorXd& p) {
  geometry.differentiate(p);
  const VectorXd errors = geometry.errors();
  const auto rows = 3 * static_cast<Index>(program.waypoints.size());
  MatrixXd slopes = MatrixXd::Zero(rows + errors.size(), p.size());
  VectorXd off = VectorXd::Zero(slopes.rows());
  for (Index i = 0; i < rows; i += 3) {
    const Waypoint& waypoint = program.waypoints[static_cast<std::size_t>(i / 3)];
    const Pose there = geometry.pose(waypoint.piece, 1);
    const auto slope = geometry.end_gradient(waypoint.piece);
    off.segment<2>(i) << there.x_m - waypoint.at_m[0], there.y_m - waypoint.at_m[1];
    slopes.middleRows<2>(i) = slope.leftCols<2>().transpose();
    if (!waypoint.heading_rad) continue;
    off[i + 2] = there.heading_rad - *waypoint.heading_rad;
    slopes.row(i + 2) = slope.col(2).transpose();
  }
  const bool are_close = off.head(rows).lpNorm<Eigen::Infinity>() < kClose && errors.norm() < kClose;
  off.head(rows) /= kWaypoint;
  slopes.topRows(rows) /= kWaypoint;
  off.tail(errors.size()) = errors / kGoal_m;
  slopes.bottomRows(errors.size()) = geometry.error_gradient() / kGoal_m;
  return {std::move(off), std::move(slopes), are_close};
}

}  // namespace

void follow_waypoints(const Program& program, VectorXd& p) {
  if (program.waypoints.empty()) return;
  PathGeometry geometry(program);
  Deviations now = deviations_of(program, geometry, p);
  double damping = 1;
  for (int step = 0; step < kFollowSteps && !now.are_close && damping < kMostDamping; ++step) {
    MatrixXd normal = now.slopes.transpose() * now.slopes;
    normal.diagonal() += damping * ease_of(program, p).cwiseInverse();
    VectorXd next = p;
    move(program, next, -normal.ldlt().solve(now.slopes.transpose() * now.weighted));
    Deviations then = deviations_of(program, geometry, next);
    const double least = now.weighted.squaredNorm(), reached = then.weighted.squaredNorm();
    if (!(reached < least)) {
      damping *= kMoreDamping;
      continue;
    }
    p = next;
    now = std::move(then);
    if (reached > (1 - kNotableGain) * least) return;
  }
}

void reach_targets(const Program& program, VectorXd& p, int steps) {
  PathGeometry geometry(program);
  for (int step = 0; step < steps; ++step) {
    geometry.differentiate(p);
    const VectorXd errors = geometry.errors();
    if (errors.norm() < 1e-13) return;
    const MatrixXd gradient = geometry.error_gradient();
    const MatrixXd eased = gradient * ease_of(program, p).asDiagonal();
    move(program, p, -eased.transpose() * (eased * gradient.transpose()).ldlt().solve(errors));
  }
}

}  // namespace joulepath::joint
