#include "diagnosis/evidence/run_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "diagnosis/numerics/indices.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kDrivenRuns = 12;
constexpr double kStudent11 = 2.201;  ///< 97.5 % quantile of Student's t with 11 degrees of freedom

/// One column, unit noise in the model; each run has its own true slope about 1.
Equations scattered_slopes(double scatter, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  Equations equations{.columns = {{Column::Kind::amplitude, 0, 0, 1e3, 0.0}},
                      .prior_sd = Eigen::VectorXd::Constant(1, 1e3)};
  for (std::size_t r = 0; r < kDrivenRuns; ++r) {
    const double slope = 1 + scatter * normal(engine);
    Eigen::MatrixXd rows(50, 2);
    for (Eigen::Index j = 0; j < rows.rows(); ++j) {
      rows(j, 0) = normal(engine);
      rows(j, 1) = slope * rows(j, 0) + normal(engine);
    }
    equations.runs.push_back({rows.transpose() * rows});
  }
  return equations;
}

struct Coverage {
  double by_noise_model{}, by_runs{};
};

Coverage coverage(double scatter, unsigned seed) {
  std::mt19937 engine(seed);
  constexpr int kDraws = 400;
  Coverage covered;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Equations equations = scattered_slopes(scatter, engine);
    const Posterior fit = solve(sum_runs(equations.runs, every(kDrivenRuns), equations.prior_sd), {0});
    const Eigen::MatrixXd sandwich =
        run_covariance(equations, every(kDrivenRuns), {0}, fit.mean, fit.covariance, 1.0);
    const double error = std::abs(fit.mean[0] - 1.0);
    covered.by_noise_model += (error < 1.96 * std::sqrt(fit.covariance(0, 0))) / double{kDraws};
    covered.by_runs += (error < kStudent11 * std::sqrt(sandwich(0, 0))) / double{kDraws};
  }
  return covered;
}

TEST(RunCovariance, CoversTheTruthWhereRunsScatterBeyondTheNoiseModel) {
  const Coverage scattered = coverage(0.4, 21);
  EXPECT_LT(scattered.by_noise_model, 0.75);
  EXPECT_GT(scattered.by_runs, 0.91);
  EXPECT_LT(scattered.by_runs, 0.985);
}

TEST(RunCovariance, AgreesWithTheNoiseModelWhereThatHolds) {
  const Coverage exact = coverage(0.0, 22);
  EXPECT_GT(exact.by_noise_model, 0.92);
  EXPECT_GT(exact.by_runs, 0.90);
}

}  // namespace
}  // namespace joulepath
