#pragma once

#include <Eigen/Dense>
#include <functional>

// Design: docs/decisions/0212-joint-path-and-speed.md
// Method: [NocedalWright2006]
namespace joulepath::joint {

/// Weight of the metric that a Newton step adds to its Hessian. It grows after short steps and falls after
/// long ones, between two limits: beyond the upper one, steps that rows keep short would freeze the path.
class Regularization {
 public:
  double value() const { return value_; }
  /// `step`: the share of the direction that was taken, after so many halvings in the line search.
  void adapt(double step, int halvings);

 private:
  double value_{0.012};
};

/// The step of a quadratic model with the Hessian plus `regularization` times the metric; right = -gradient.
/// Where that sum is not positive definite, the sizes of the Hessian's eigenvalues in the metric count
/// ([NocedalWright2006], 3.4): a saddle repels, and the other directions keep their steps, which a larger
/// regularization would shorten. `damped`: the sum, symmetric [n x n]; `metric`: makes the metric, positive
/// definite [n x n], only asked for where the sum is not; `right`: [n].
[[nodiscard]] Eigen::VectorXd descent(const Eigen::MatrixXd& damped,
                                      const std::function<Eigen::MatrixXd()>& metric, double regularization,
                                      const Eigen::VectorXd& right);

}  // namespace joulepath::joint
