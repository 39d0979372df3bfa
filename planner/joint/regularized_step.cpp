#include "planner/joint/regularized_step.hpp"

#include <algorithm>

namespace joulepath::joint {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// Tuned on 26 missions in two warehouses, a hall and among boxes, checked on 26 others.
constexpr double kLeastWeight = 1e-3, kMostWeight = 10;
constexpr double kShortStep = 0.2, kLongStep = 0.5;
constexpr double kAfterShort = 4, kAfterLong = 0.4;
constexpr int kHardSearch = 3;  ///< halvings: a bend that the model does not know
constexpr double kAfterHard = 6, kLeastAfterHard = 0.01;

}  // namespace

void Regularization::adapt(double step, int halvings) {
  if (halvings >= kHardSearch) value_ = std::max(kAfterHard * value_, kLeastAfterHard);
  if (step < kShortStep) value_ *= kAfterShort;
  if (step >= kLongStep) value_ *= kAfterLong;
  value_ = std::clamp(value_, kLeastWeight, kMostWeight);
}

VectorXd descent(const MatrixXd& damped, const std::function<MatrixXd()>& make_metric, double regularization,
                 const VectorXd& right) {
  const Eigen::LLT<MatrixXd> convex(damped);
  if (convex.info() == Eigen::Success) return convex.solve(right);
  const MatrixXd metric = make_metric();
  const Eigen::LLT<MatrixXd> root(metric);
  const MatrixXd half = root.matrixL().solve(damped - regularization * metric);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> in_metric(root.matrixL().solve(half.transpose()));
  const VectorXd sizes = in_metric.eigenvalues().cwiseAbs().array() + regularization;
  const VectorXd along = in_metric.eigenvectors().transpose() * root.matrixL().solve(right);
  return root.matrixU().solve(in_metric.eigenvectors() * along.cwiseQuotient(sizes));
}

}  // namespace joulepath::joint
