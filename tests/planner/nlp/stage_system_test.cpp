// Newton systems solved from segment to segment, against a dense solution of the same system.
#include "planner/nlp/fast/stage_system.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace joulepath::nlp {
namespace {

constexpr int kSegments = 7, kInner = kSegments - 1;

/// Column of a segment's local unknown in the dense system, -1 at the fixed ends.
int column(int segment, int local) {
  if (local == 4) return 2 * kInner + segment;
  const int node = segment + local / 2;
  return node == 0 || node == kSegments ? -1 : 2 * (node - 1) + local % 2;
}

StageSystem random_system(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  StageSystem system(kSegments);
  for (Stage& stage : system.stages) {
    Eigen::Matrix<double, 5, 5> root;
    for (double& x : root.reshaped()) x = normal(random);
    const Eigen::Matrix<double, 5, 5> hessian = root * root.transpose();
    for (std::size_t i = 0; i < 5; ++i) {
      stage.gradient[i] = normal(random);
      stage.border[i] = normal(random);
      for (std::size_t j = 0; j < 5; ++j)
        stage.hessian[i][j] = hessian(static_cast<int>(i), static_cast<int>(j));
    }
    for (std::size_t i = 0; i < 2; ++i) {
      for (double& x : stage.equality[i]) x = normal(random);
      stage.wanted[i] = normal(random);
    }
  }
  return system;
}

TEST(StageSystem, IsTheDenseSolution) {
  constexpr int kUnknowns = 2 * kInner + kSegments, kRows = 2 * kSegments;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    StageSystem system = random_system(seed);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(kUnknowns + kRows, kUnknowns + kRows);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(kUnknowns + kRows, 2);
    for (int k = 0; k < kSegments; ++k) {
      const Stage& stage = system.stages[static_cast<std::size_t>(k)];
      for (int i = 0; i < 5; ++i) {
        const int row = column(k, i);
        const auto at = static_cast<std::size_t>(i);
        if (row < 0) continue;
        right(row, 0) -= stage.gradient[at];
        right(row, 1) -= stage.border[at];
        for (int j = 0; j < 5; ++j)
          if (column(k, j) >= 0) matrix(row, column(k, j)) += stage.hessian[at][static_cast<std::size_t>(j)];
        for (int e = 0; e < 2; ++e) {
          const int equality = kUnknowns + 2 * k + e;
          matrix(row, equality) = matrix(equality, row) = stage.equality[static_cast<std::size_t>(e)][at];
        }
      }
      for (int e = 0; e < 2; ++e) right(kUnknowns + 2 * k + e, 0) = stage.wanted[static_cast<std::size_t>(e)];
    }
    const Eigen::MatrixXd exact = matrix.fullPivLu().solve(right);
    ASSERT_TRUE(system.solve());
    std::vector<std::array<double, 2>> multipliers;
    constexpr double kBorder = 0.7;
    system.multipliers(kBorder, multipliers);
    for (int k = 0; k < kSegments; ++k) {
      const auto at = static_cast<std::size_t>(k);
      for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 2; ++j) {
          const double wanted = column(k, i) < 0 ? 0.0 : exact(column(k, i), j);
          EXPECT_NEAR(system.step(at)[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)], wanted,
                      1e-7);
        }
      for (int e = 0; e < 2; ++e) {
        const int row = kUnknowns + 2 * k + e;
        EXPECT_NEAR(multipliers[at][static_cast<std::size_t>(e)], exact(row, 0) + kBorder * exact(row, 1),
                    1e-6);
      }
    }
  }
}

TEST(StageSystem, NegativeCurvatureIsSaid) {
  StageSystem system = random_system(3);
  for (Stage& stage : system.stages)
    for (auto& row : stage.hessian)
      for (double& h : row) h = -h;
  EXPECT_FALSE(system.solve());
}

}  // namespace
}  // namespace joulepath::nlp
