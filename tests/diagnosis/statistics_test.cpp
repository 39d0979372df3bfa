#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "diagnosis/evidence/walk_noise.hpp"
#include "diagnosis/evidence/whitening.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/normal_equations.hpp"
#include "diagnosis/numerics/resample.hpp"
#include "diagnosis/numerics/smoothing.hpp"

namespace joulepath {
namespace {

using Presence = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Rows of pure AR(1) noise in every channel.
ResidualRows noise_rows(Eigen::Index samples, double memory, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  ResidualRows rows{.value = Eigen::MatrixXd::Zero(samples, kChannelCount)};
  rows.present.setConstant(samples, kChannelCount, true);
  for (Eigen::Index c = 0; c < kChannelCount; ++c)
    for (Eigen::Index t = 0; t < samples; ++t)
      rows.value(t, c) = (t > 0 ? memory * rows.value(t - 1, c) : 0.0) + normal(engine);
  return rows;
}

TEST(Smoothing, PassesConstantsAndGivesTheSlopeOfALine) {
  const SmoothingKernel kernel = gaussian_kernel(0.06, 0.02);
  std::vector<double> line;
  for (int i = 0; i < 60; ++i) line.push_back(3.0 + 0.5 * 0.02 * i);
  EXPECT_NEAR(convolve_at(line, kernel.weight, 30), line[30], 1e-12);
  EXPECT_NEAR(convolve_at(line, kernel.slope_weight, 30), 0.5, 1e-12);
}

TEST(Whitening, LeavesUnitUncorrelatedEntriesOfColoredNoise) {
  std::mt19937 engine(7);
  std::vector<ResidualRows> runs;
  for (int r = 0; r < 10; ++r) runs.push_back(noise_rows(400, 0.7, engine));
  const NoiseModel noise = estimate_noise(runs);
  EXPECT_NEAR(noise.memory[kGyro].coefficient[0], 0.7, 0.06);
  const Whitener whiten(noise, runs[0].present);
  const Eigen::VectorXd white = whiten(runs[0].value);
  EXPECT_NEAR(white.squaredNorm() / static_cast<double>(white.size()), 1.0, 0.08);
  double neighbors = 0;
  for (Eigen::Index i = kChannelCount; i < white.size(); ++i)
    neighbors += white[i] * white[i - kChannelCount];
  EXPECT_NEAR(neighbors / static_cast<double>(white.size()), 0.0, 0.05);
}

/// A run's heading: a random walk beside AR(2) noise with the coefficients 0.9 and -0.3.
ResidualRows walking_rows(Eigen::Index samples, double step_sd, double short_sd, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  ResidualRows rows{.value = Eigen::MatrixXd::Zero(samples, kChannelCount)};
  rows.present.setConstant(samples, kChannelCount, false);
  rows.present.col(kHeading).setConstant(true);
  double walk = 0, now = 0, before = 0;
  for (Eigen::Index t = 0; t < samples; ++t) {
    walk += step_sd * normal(engine);
    before = std::exchange(now, 0.9 * now - 0.3 * before + short_sd * normal(engine));
    rows.value(t, kHeading) = walk + now;
  }
  return rows;
}

std::vector<ResidualRows> walking_runs(double step_sd, double short_sd) {
  std::mt19937 engine(11);
  std::vector<ResidualRows> runs;
  for (int r = 0; r < 24; ++r) runs.push_back(walking_rows(400, step_sd, short_sd, engine));
  return runs;
}

/// Mean product of the entries of all runs with those `lag` later.
double product_of_entries(const Whitener& whiten, const std::vector<ResidualRows>& runs, Eigen::Index lag) {
  double sum = 0, count = 0;
  for (const ResidualRows& run : runs) {
    const Eigen::VectorXd white = whiten(run.value);
    sum += white.head(white.size() - lag).dot(white.tail(white.size() - lag));
    count += static_cast<double>(white.size() - lag);
  }
  return sum / count;
}

TEST(Whitening, LeavesUnitUncorrelatedEntriesOfAWalkBesideShortNoise) {
  const std::vector<ResidualRows> runs = walking_runs(0.5, 1.0);
  const NoiseModel noise = estimate_noise(runs);
  EXPECT_NEAR(noise.walk[kHeading].step_variance, 0.25, 0.05);
  EXPECT_NEAR(noise.walk[kHeading].memory.coefficient[0], 0.9, 0.1);
  EXPECT_NEAR(noise.walk[kHeading].memory.coefficient[1], -0.3, 0.1);
  const Whitener whiten(noise, runs[0].present);
  EXPECT_NEAR(product_of_entries(whiten, runs, 0), 1.0, 0.03);
  EXPECT_NEAR(noise.innovation_covariance(kHeading, kHeading), noise.walk[kHeading].settled_variance, 0.1);
  for (Eigen::Index lag : {1, 2, 3, 5, 10, 30}) EXPECT_NEAR(product_of_entries(whiten, runs, lag), 0.0, 0.05);
}

TEST(Whitening, ALevelTellsNothingAboutAWalkAndASlopeItsSteps) {
  const NoiseModel noise = estimate_noise(walking_runs(0.5, 0.01));
  const Presence present = walking_runs(0.5, 0.01)[0].present;
  const Eigen::MatrixXd level = Eigen::MatrixXd::Constant(present.rows(), kChannelCount, 1.0);
  const Eigen::MatrixXd slope = Eigen::VectorXd::LinSpaced(present.rows(), 0, 1).replicate(1, kChannelCount);
  const Whitener whiten(noise, present);
  EXPECT_LT(whiten(level).squaredNorm(), 1e-3);  // its start is unknown
  // The differences of a walk are white: 399 steps of 1/399 each, of variance 1/4.
  EXPECT_NEAR(whiten(slope).squaredNorm(), 4.0 / 399, 0.2 * 4.0 / 399);
}

TEST(Whitening, AWalkThatIsNotThereChangesLittle) {
  const std::vector<ResidualRows> runs = walking_runs(0.0, 1.0);
  NoiseModel noise = estimate_noise(runs);
  const Eigen::VectorXd with_walk = Whitener(noise, runs[0].present)(runs[0].value);
  EXPECT_LT(noise.walk[kHeading].step_variance, 0.01);
  noise.walk = {};
  const Eigen::VectorXd without = Whitener(noise, runs[0].present)(runs[0].value);
  EXPECT_LT((with_walk - without).squaredNorm(), 0.05 * without.squaredNorm());
}

TEST(Whitening, AWalkPassesRowsThatAreAbsent) {
  std::vector<ResidualRows> runs = walking_runs(0.5, 0.3);
  for (ResidualRows& run : runs)
    for (int t = 100; t < 140; ++t) run.present(t, kHeading) = false;
  const Whitener whiten(estimate_noise(runs), runs[0].present);
  EXPECT_EQ(whiten.entries(), 360);
  EXPECT_NEAR(product_of_entries(whiten, runs, 0), 1.0, 0.05);
  double after = 0;  // the walk went on for 40 samples: its size there is known
  for (const ResidualRows& run : runs) after += std::pow(whiten(run.value)[100], 2) / 24;
  EXPECT_NEAR(after, 1.0, 0.7);
}

TEST(Whitening, AbsentRowsDoNotCount) {
  std::mt19937 engine(8);
  ResidualRows rows = noise_rows(100, 0.3, engine);
  rows.present.col(kCurrentLeft).setConstant(false);
  for (int t = 40; t < 50; ++t) rows.present.row(t).setConstant(false);
  const Whitener whiten(estimate_noise({rows}), rows.present);
  EXPECT_EQ(whiten.entries(), 90 * (kChannelCount - 1));
}

/// Runs whose level differs by `spread` around `common`, measured with unit noise.
std::vector<RawRunEquations> scattered_runs(int runs, int samples, double common, double spread,
                                            std::mt19937& engine) {
  std::normal_distribution<double> normal;
  std::vector<RawRunEquations> raw;
  for (int r = 0; r < runs; ++r) {
    const double level = common + spread * normal(engine);
    Eigen::MatrixXd rows(samples, 3);
    for (int t = 0; t < samples; ++t) rows.row(t) << 1.0, 1.0, level + normal(engine);
    raw.push_back({.gram = rows.transpose() * rows, .columns = 1, .own_columns = 1});
  }
  return raw;
}

TEST(RunEffects, TheirVarianceIsRecovered) {
  std::mt19937 engine(9);
  const auto raw = scattered_runs(200, 100, 0.0, 0.5, engine);
  const Eigen::VectorXd variance = run_variances(raw, {Eigen::VectorXd::Zero(1), Eigen::MatrixXd::Zero(1, 1)},
                                                 Eigen::VectorXd::Constant(1, 0.1));
  EXPECT_NEAR(std::sqrt(variance[0]), 0.5, 0.06);
}

/// Runs whose level a rich fit can draw in part: `curves` columns, constant in each run.
std::vector<RawRunEquations> absorbed_runs(int runs, int curves, double spread, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  std::vector<RawRunEquations> raw;
  for (int r = 0; r < runs; ++r) {
    const double level = spread * normal(engine);
    Eigen::VectorXd place(curves);
    for (double& x : place) x = normal(engine);
    Eigen::MatrixXd rows(100, curves + 2);
    for (Eigen::Index t = 0; t < rows.rows(); ++t)
      rows.row(t) << place.transpose(), 1.0, level + normal(engine);
    raw.push_back({.gram = rows.transpose() * rows, .columns = curves, .own_columns = 1});
  }
  return raw;
}

TEST(RunEffects, TheirVarianceIsRecoveredFromFewRunsThatARichFitAbsorbs) {
  std::mt19937 engine(13);
  constexpr int kFewRuns = 8, kCurves = 5, kDraws = 100, kPasses = 5;
  double sum = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto raw = absorbed_runs(kFewRuns, kCurves, 0.5, engine);
    Eigen::VectorXd variance = Eigen::VectorXd::Constant(1, 0.1);
    for (int pass = 0; pass < kPasses; ++pass) {
      std::vector<RunEquations> runs;
      for (const RawRunEquations& run : raw) runs.push_back(marginalize(run, variance));
      const LinearProblem problem = sum_runs(runs, every(kFewRuns), Eigen::VectorXd::Constant(kCurves, 10.0));
      const Posterior rich = solve(problem, {0, 1, 2, 3, 4});
      variance = run_variances(raw, {rich.mean, rich.covariance}, variance);
    }
    sum += variance[0];
  }
  EXPECT_NEAR(sum / kDraws, 0.25, 0.06);
}

TEST(RunEffects, IntervalsCoverTheTruthAtTheirRate) {
  std::mt19937 engine(10);
  int covered = 0;
  constexpr int kDraws = 300;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto raw = scattered_runs(16, 60, 1.0, 0.4, engine);
    std::vector<RunEquations> runs;
    std::vector<std::size_t> all;
    for (const RawRunEquations& run : raw) {
      all.push_back(runs.size());
      runs.push_back(marginalize(run, Eigen::VectorXd::Constant(1, 0.16)));
    }
    const Posterior posterior = solve(sum_runs(runs, all, Eigen::VectorXd::Constant(1, 100.0)), {0});
    covered += std::abs(posterior.mean[0] - 1.0) < 1.96 * std::sqrt(posterior.covariance(0, 0));
  }
  EXPECT_GT(covered, 0.91 * kDraws);
  EXPECT_LT(covered, 0.985 * kDraws);
}

TEST(Evidence, StaysBelowItsCostOnNoiseAlone) {
  std::mt19937 engine(11);
  std::normal_distribution<double> normal;
  int alarms = 0;
  constexpr int kDraws = 400;
  for (int draw = 0; draw < kDraws; ++draw) {
    RunEquations run{.gram = Eigen::MatrixXd::Zero(6, 6)};
    Eigen::MatrixXd rows(200, 6);
    for (Eigen::Index i = 0; i < rows.size(); ++i) rows.data()[i] = normal(engine);
    run.gram = rows.transpose() * rows;
    const LinearProblem problem = sum_runs({run}, {0}, Eigen::VectorXd::Constant(5, 1.0));
    const double nothing = solve(problem, {}).log_evidence;
    double best = -1e300;
    for (int column = 0; column < 5; ++column) best = std::max(best, solve(problem, {column}).log_evidence);
    alarms += best - nothing > 6.0;
  }
  EXPECT_LE(alarms, kDraws / 100);
}

TEST(Evidence, ProjectingOutEqualsFittingTogether) {
  std::mt19937 engine(12);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd rows(80, 4);
  for (Eigen::Index i = 0; i < rows.size(); ++i) rows.data()[i] = normal(engine);
  const RunEquations run{.gram = rows.transpose() * rows};
  const LinearProblem problem = sum_runs({run}, {0}, Eigen::VectorXd::Constant(3, 0.7));
  const Posterior together = solve(problem, {0, 1, 2});
  const Posterior after = solve(project_out(problem, {0}, {1, 2}), {0, 1});
  EXPECT_NEAR(together.mean[1], after.mean[0], 1e-12);
  EXPECT_NEAR(together.mean[2], after.mean[1], 1e-12);
  EXPECT_NEAR(together.loss, after.loss, 1e-9);
}

TEST(Bootstrap, IsTheSameEveryTimeAndHoldsTheMean) {
  const std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const auto mean = [&](const std::vector<std::size_t>& chosen) {
    double sum = 0;
    for (std::size_t i : chosen) sum += values[i];
    return sum / static_cast<double>(chosen.size());
  };
  const auto first = bootstrap_interval(values.size(), 500, mean),
             second = bootstrap_interval(values.size(), 500, mean);
  EXPECT_EQ(first, second);
  EXPECT_LT(first.first, 5.5);
  EXPECT_GT(first.second, 5.5);
}

/// Yule-Walker: rho_1 = a_1/(1 - a_2), rho_2 = a_1 rho_1 + a_2.
TEST(Autoregression, IsThatOfItsAutocovariances) {
  for (const auto& [a1, a2] : {std::pair{0.6, -0.3}, std::pair{0.4, 0.3}, std::pair{-0.5, 0.2}}) {
    const double rho1 = a1 / (1 - a2), rho2 = a1 * rho1 + a2;
    const Autoregression found = fit_autoregression({2.0, 2.0 * rho1, 2.0 * rho2});
    EXPECT_NEAR(found.coefficient[0], a1, 1e-12);
    EXPECT_NEAR(found.coefficient[1], a2, 1e-12);
    EXPECT_NEAR(found.innovation_ratio, std::sqrt(1 - a1 * rho1 - a2 * rho2), 1e-12);
  }
}

}  // namespace
}  // namespace joulepath
