#pragma once

#include <Eigen/Dense>
#include <vector>

#include "planner/joint/joint_problem.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
// Method: [NocedalWright2006]
namespace joulepath::joint {

struct NewtonOptions {
  double tolerance{2e-3};  ///< complementarity, constraints and gradient, relative to the cost
  int most_steps{100};
  double gap{0.3};             ///< of the first complementarity, relative to the cost
  double give_up_J{kNoLimit};  ///< stops where a bound of the cost is above
};

/// A solution, or the state at which the method stopped.
struct JointSolution {
  bool converged{};
  bool feasible{};  ///< nearly: the targets and rows hold to percents, whatever is left to gain
  double cost_J{};  ///< energy and the price of time
  double duration_s{};
  Eigen::VectorXd parameters{};  ///< see Program
  Eigen::VectorXd squares{};     ///< (dtau/dt)^2 at the nodes
  int steps{};
};

/// The cheapest path and speed near a start: a primal-dual interior-point Newton method over the squares of
/// the rate at the nodes and the path's parameters together, with exact second derivatives, also of the end
/// poses and the clearance. `squares`: of the start; empty: from a pass of its own.
[[nodiscard]] JointSolution solve(const Start& start, const NewtonOptions& options,
                                  const Eigen::VectorXd& squares = {});

}  // namespace joulepath::joint
