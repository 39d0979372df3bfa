#include "planner/joint/regularized_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace joulepath::joint {
namespace {

/// In a metric of its own, with the curvatures 3, -2 and 0.5 of its axes.
TEST(RegularizedStep, ASaddleRepelsAndOtherAxesKeepTheirSteps) {
  const Eigen::Matrix3d root{{1, 0, 0}, {0.4, 2, 0}, {-0.3, 0.7, 0.5}};
  const Eigen::Matrix3d metric = root * root.transpose();
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  const Eigen::Vector3d curvature{3, -2, 0.5}, along{0.7, -1.1, 0.4};
  const Eigen::Matrix3d hessian = root * axes * curvature.asDiagonal() * axes.transpose() * root.transpose();
  const Eigen::Vector3d right = root * axes * along;
  const double regularization = 0.1;
  const Eigen::Vector3d step = descent(
      hessian + regularization * metric, [&] { return Eigen::MatrixXd(metric); }, regularization, right);
  const Eigen::Vector3d in_axes = axes.transpose() * root.transpose() * step;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(in_axes[i], along[i] / (std::abs(curvature[i]) + regularization), 1e-12) << i;
  const Eigen::VectorXd convex = descent(
      hessian + 2.5 * metric, [&] { return Eigen::MatrixXd(metric); }, 2.5, right);
  EXPECT_LT((hessian * convex + 2.5 * metric * convex - right).norm(), 1e-12);
}

TEST(RegularizedStep, RegularizationStaysBetweenItsLimits) {
  Regularization regularization;
  for (int i = 0; i < 100; ++i) regularization.adapt(1e-3, 6);
  EXPECT_LE(regularization.value(), 10);
  for (int i = 0; i < 100; ++i) regularization.adapt(1, 0);
  EXPECT_GE(regularization.value(), 1e-3);
  EXPECT_LT(regularization.value(), 0.012);
}

}  // namespace
}  // namespace joulepath::joint
