#pragma once

#include "planner/joint/joint_problem.hpp"

namespace joulepath::joint {

/// Parameters whose path passes near the waypoints (Levenberg-Marquardt): a rough path of lines and arcs
/// drifts by metres on a long leg.
void follow_waypoints(const Program& program, Eigen::VectorXd& parameters);

/// The nearest parameters that reach the targets (Gauss-Newton), as far as `steps` go.
void reach_targets(const Program& program, Eigen::VectorXd& parameters, int steps);

}  // namespace joulepath::joint
