#pragma once

#include <Eigen/Dense>
#include <memory>

#include "planner/joint/joint_problem.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
// Method: [NocedalWright2006]
namespace joulepath::joint {

struct NewtonOptions {
  double tolerance{2e-3};      ///< complementarity, constraints and gradient, relative to the cost
  int most_steps{100};         ///< in all
  double give_up_J{kNoLimit};  ///< stops where a bound of the cost is above
  double pause{0};             ///< stops, to be continued, where what `tolerance` bounds is below
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
/// poses and the clearance.
class JointNewton {
 public:
  /// `gap`: of the first complementarity, relative to the cost; `squares`: of the start; empty: from a pass
  /// of its own.
  explicit JointNewton(const Start& start, double gap = 0.3, const Eigen::VectorXd& squares = {});
  JointNewton(JointNewton&&) noexcept;
  ~JointNewton();

  /// Goes on from where it stopped. Stops between do not change the steps.
  JointSolution run(const NewtonOptions& options);

 private:
  class Steps;
  std::unique_ptr<Steps> steps_;
};

}  // namespace joulepath::joint
