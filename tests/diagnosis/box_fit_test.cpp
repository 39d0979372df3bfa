// Least squares with bounds, by the conditions of its optimum.
#include "diagnosis/checks/box_fit.hpp"

#include <gtest/gtest.h>

#include <random>

namespace joulepath {
namespace {

TEST(BoxFit, IsLeastSquaresInsideOfTheBoxes) {
  const Eigen::Vector4d a(1, 2, 3, 4), b(1, -1, 1, 0);
  const BoxFit fit = fit_in_box(2 * a - 0.5 * b, {{a, 0, 3}, {b, -1, 1}});
  EXPECT_NEAR(fit.coefficient[0], 2, 1e-9);
  EXPECT_NEAR(fit.coefficient[1], -0.5, 1e-9);
  EXPECT_NEAR(fit.unexplained, 0, 1e-12);
}

TEST(BoxFit, OfNothingOrByNothingIsPlain) {
  const Eigen::Vector2d one(1, 0), other(0, 1), zero(0, 0);
  EXPECT_EQ(fit_in_box(zero, {{one, -1, 1}}).unexplained, 0.0);
  EXPECT_EQ(fit_in_box(one, {{other, -1, 1}}).unexplained, 1.0);
  EXPECT_EQ(fit_in_box(one, {{zero, 0.5, 1}}).coefficient[0], 0.5) << "a term without values takes its least";
}

/// Inside of its box a coefficient's slope is zero; at a border it points outwards.
TEST(BoxFit, MeetsTheConditionsOfTheOptimumWithCorrelatedTerms) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::VectorXd::NullaryExpr(40, [&] { return normal(random); }).eval(); };
  int held = 0;
  for (int problem = 0; problem < 30; ++problem) {
    const Eigen::VectorXd common = draw(), explained = draw() + common;
    std::vector<BoxedTerm> terms;
    for (int k = 0; k < 3; ++k) terms.push_back({draw() + common, -0.1, 0.3});
    const BoxFit fit = fit_in_box(explained, terms);
    Eigen::VectorXd rest = explained;
    for (int k = 0; k < 3; ++k) rest -= fit.coefficient[k] * terms[static_cast<std::size_t>(k)].value;
    EXPECT_NEAR(fit.unexplained, rest.squaredNorm() / explained.squaredNorm(), 1e-12);
    for (int k = 0; k < 3; ++k) {
      const double uphill = terms[static_cast<std::size_t>(k)].value.dot(rest), c = fit.coefficient[k];
      const bool low = c == -0.1, high = c == 0.3;
      held += low || high;
      EXPECT_LE(uphill, high ? 1e300 : 1e-6) << problem;
      EXPECT_GE(uphill, low ? -1e300 : -1e-6) << problem;
    }
  }
  EXPECT_GT(held, 10);
}

}  // namespace
}  // namespace joulepath
