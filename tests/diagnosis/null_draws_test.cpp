#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"

namespace joulepath {
namespace {

constexpr int kRuns = 12, kSamples = 40, kCalibrations = 3, kEffects = 20;

/// One drawn day at the level of the statistics: whitened rows, calibration errors from their prior, effects
/// with columns that overlap with them, and (not in a null) one effect of a known size.
Equations draw_day(std::mt19937& engine, double amplitude, std::size_t runs = kRuns) {
  std::normal_distribution<double> normal;
  Equations equations;
  for (int k = 0; k < kCalibrations; ++k)
    equations.columns.push_back({Column::Kind::nuisance, k, 0, 0.05, 0.0});
  for (int c = 0; c < kEffects; ++c) {
    equations.columns.push_back({Column::Kind::amplitude, c, 0, 1.0, 0.0});
    equations.candidates.push_back(
        {.shape = {.name = std::string(effect_catalog()[static_cast<std::size_t>(c)].info.name)},
         .amplitude = {"size"},
         .step = {0.25}});
  }
  constexpr int kColumns = kCalibrations + kEffects;
  equations.prior_sd.resize(kColumns);
  for (int k = 0; k < kColumns; ++k)
    equations.prior_sd[k] = equations.columns[static_cast<std::size_t>(k)].prior_sd;
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(kColumns);
  for (int k = 0; k < kCalibrations; ++k) truth[k] = 0.05 * normal(engine);
  truth[kCalibrations] = amplitude;
  for (std::size_t r = 0; r < runs; ++r) {
    Eigen::MatrixXd rows(kSamples, kColumns + 1);
    for (int t = 0; t < kSamples; ++t) {
      for (int k = 0; k < kColumns; ++k) rows(t, k) = normal(engine);
      for (int c = 0; c < kEffects; ++c) rows(t, kCalibrations + c) += 0.5 * rows(t, c % kCalibrations);
      rows(t, kColumns) = rows.row(t).head(kColumns).dot(truth) + normal(engine);
    }
    equations.runs.push_back({.gram = rows.transpose() * rows});
  }
  return equations;
}

TEST(NullDraws, RaiseAtMostOneAlarmInAHundred) {
  std::mt19937 engine(2024);
  constexpr int kDraws = 300;
  int alarms = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Equations day = draw_day(engine, 0.0);
    const auto explanations =
        search_explanations(without_calibration(day, every(kRuns)), day, {.most_effects = 2});
    alarms += !explanations.front().candidates.empty();
  }
  EXPECT_LE(alarms, kDraws / 100);
}

/// Whether the first effect, of `share` of the just material amplitude in every run, is beyond doubt.
bool is_beyond_doubt(double share, std::size_t runs) {
  constexpr double kLeast = 0.35;
  std::mt19937 engine(2026);
  const Equations day = draw_day(engine, share * kLeast, runs);
  SearchOptions options = search_options(1.0, runs, std::vector<double>(kEffects, kLeast));
  options.most_effects = 1;
  for (const Explanation& e : search_explanations(without_calibration(day, every(runs)), day, options))
    if (e.candidates == std::vector<int>{0}) return e.small.empty();
  return false;
}

/// An error of the model, the same in all runs, is no effect, however many runs repeat it.
TEST(NullDraws, MoreRunsDoNotTurnAnErrorOfTheModelIntoAName) {
  for (const std::size_t runs : {12u, 120u, 1200u})
    for (const double share : {0.1, 0.2, 0.3}) EXPECT_FALSE(is_beyond_doubt(share, runs)) << share << ' ' << runs;
  EXPECT_TRUE(is_beyond_doubt(0.8, 120));
}

TEST(EffectDraws, AreFoundAndTheirIntervalsCoverTheTruth) {
  std::mt19937 engine(2025);
  constexpr int kDraws = 300;
  constexpr double kSize = 0.35;  // about seven standard deviations
  int found = 0, covered = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const Equations day = draw_day(engine, kSize);
    const Explanation best =
        search_explanations(without_calibration(day, every(kRuns)), day, {.most_effects = 2}).front();
    found += best.candidates == std::vector<int>{0};
    Eigen::MatrixXd covariance;
    const Eigen::VectorXd parameters = fit_parameters(day, every(kRuns), {kCalibrations}, 1.0, &covariance);
    const double sd = std::sqrt(covariance(kCalibrations, kCalibrations));
    covered += std::abs(parameters[kCalibrations] - kSize) < 1.96 * sd;
  }
  EXPECT_GE(found, 0.97 * kDraws);
  EXPECT_GT(covered, 0.92 * kDraws);
  EXPECT_LT(covered, 0.98 * kDraws);
}

}  // namespace
}  // namespace joulepath
