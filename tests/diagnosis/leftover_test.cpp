#include "diagnosis/evidence/leftover.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "diagnosis/evidence/left_out_gain.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

constexpr int kRows = 200, kLeftoverRuns = 8;

/// Runs with one nuisance and two families of a dictionary: "steady" is one entry that has the same part in
/// every run's gap; "private" has an entry for each run that makes up its gap and is nothing in the others.
Identification two_families() {
  Identification id;
  id.nuisances = {{"resistance_ohm", std::nullopt, 0.05}};
  id.equations.columns = {{Column::Kind::nuisance, 0, 0, 0.05, 0.0},
                          {Column::Kind::dictionary, 0, 0, 10.0, 0.0}};
  id.equations.dictionary = {{"steady", "current"}};
  for (int run = 0; run < kLeftoverRuns; ++run) {
    id.equations.dictionary.push_back({"private", "current"});
    id.equations.columns.push_back({Column::Kind::dictionary, run + 1, 0, 10.0, 0.0});
  }
  id.equations.prior_sd = Eigen::VectorXd::Constant(kLeftoverRuns + 2, 10.0);
  id.equations.prior_sd[0] = 0.05;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int run = 0; run < kLeftoverRuns; ++run) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kRows, kLeftoverRuns + 3);
    for (int column : {0, 1, run + 2, kLeftoverRuns + 2})
      rows.col(column) = Eigen::VectorXd::NullaryExpr(kRows, [&] { return normal(random); });
    rows.col(kLeftoverRuns + 2) += 0.5 * rows.col(1) + 0.5 * rows.col(run + 2);
    id.equations.runs.push_back({rows.transpose() * rows});
  }
  return id;
}

TEST(LeftOutGain, CountsWhatRepeatsItselfFromRunToRunOnly) {
  const Identification id = two_families();
  const auto gains = left_out_gains(id, {}, dictionary_families(id.equations));
  const LeftOutGain steady = gains.at("steady (current)"), own = gains.at("private (current)");
  const double expected = kLeftoverRuns * kRows * 0.25;
  EXPECT_NEAR(steady.gain, expected, 0.3 * expected);
  EXPECT_GT(steady.over_scatter, 5);
  EXPECT_NEAR(own.gain, 0.0, 0.05 * expected);
}

/// Runs whose gap is one constant's error of so many sigmas, and noise.
Identification wrong_constant(double sigmas) {
  Identification id;
  id.nuisances = {{"resistance_ohm", std::nullopt, 0.05}};
  id.equations.columns = {{Column::Kind::nuisance, 0, 0, 0.05, 0.0}};
  id.equations.prior_sd = Eigen::VectorXd::Constant(1, 0.05);
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<std::size_t> runs;
  for (int run = 0; run < kLeftoverRuns; ++run) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::NullaryExpr(kRows, 2, [&] { return normal(random); });
    rows.col(1) += sigmas * 0.05 * rows.col(0);
    id.equations.runs.push_back({rows.transpose() * rows});
    runs.push_back(runs.size());
  }
  id.problem = without_calibration(id.equations, runs);
  return id;
}

/// A gap of x sigmas in 1,600 rows: held at 3 sigmas it leaves 4 (x - 3)^2 log units of loss, fitted with its
/// prior 0.8 x^2. The difference is 209 at 12 sigmas.
TEST(Leftover, IsAConstantFarOutsideOfItsCalibration) {
  for (const double sigmas : {0.0, 2.0, 4.0}) {
    const Leftover inside = find_leftover(wrong_constant(sigmas), {});
    EXPECT_FALSE(inside.significant) << sigmas;
    EXPECT_EQ(inside.description, "") << sigmas;
  }
  const Leftover outside = find_leftover(wrong_constant(12), {});
  EXPECT_TRUE(outside.significant);
  EXPECT_EQ(outside.share, 1.0);
  EXPECT_GT(outside.evidence, 50.0);
  EXPECT_NE(outside.description.find("goes with resistance_ohm"), std::string::npos) << outside.description;
}

/// Two candidates, one column each, whose signatures have this cosine.
Equations pair_with_cosine(double cosine, LinearProblem& problem, double unit = 3) {
  Equations equations;
  equations.candidates = {Candidate{.shape = {.name = "viscous_friction"}},
                          Candidate{.shape = {.name = "quadratic_drag"}}};
  equations.columns = {{Column::Kind::amplitude, 0, 0, 1.0, 0.0}, {Column::Kind::amplitude, 1, 0, 1.0, 0.0}};
  problem.gram = Eigen::MatrixXd::Identity(2, 2) * unit * unit;
  problem.gram(0, 1) = problem.gram(1, 0) = unit * unit * cosine;
  return equations;
}

TEST(GhostShare, IsWhatOthersCanDrawOfASignature) {
  const Explanation both{.candidates = {0, 1}, .columns = {0, 1}};
  LinearProblem problem;
  const Equations apart = pair_with_cosine(0.0, problem);
  EXPECT_NEAR(ghost_share(problem, apart, both, 1), 0.0, 1e-12);
  const Equations near = pair_with_cosine(0.25, problem);
  EXPECT_NEAR(ghost_share(problem, near, both, 1), 0.25 * 0.25 / 0.25, 1e-3);
  const Equations alike = pair_with_cosine(0.9, problem);
  EXPECT_EQ(ghost_share(problem, alike, both, 1), 1.0);
  const Explanation alone{.candidates = {1}, .columns = {1}};
  EXPECT_EQ(ghost_share(problem, alike, alone, 1), 0.0);
}

TEST(GhostShare, DoesNotDependOnTheUnitsOfAmplitudes) {
  const Explanation both{.candidates = {0, 1}, .columns = {0, 1}};
  for (const double unit : {1e-3, 1e3}) {
    LinearProblem problem;
    const Equations near = pair_with_cosine(0.25, problem, unit);
    EXPECT_NEAR(ghost_share(problem, near, both, 1), 0.25, 1e-3) << unit;
  }
}

/// A true effect outside of the catalog, and a word of the expected answer.
struct TakenOut {
  std::string effect{};
  double size{};
  std::string word{};
};

class EffectTakenOut : public ::testing::TestWithParam<TakenOut> {};

TEST_P(EffectTakenOut, IsCalledUnexplainedAndTellsWhatItGoesWith) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const TakenOut& c = GetParam();
  const Diagnosis d =
      diagnose(testing::blind_day(c.effect, c.size, 0, 12, 31), {.bootstrap = 20, .without = {c.effect}});
  EXPECT_EQ(d.verdict, Verdict::unexplained) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_NE(d.leftover_description.find(c.word), std::string::npos) << d.leftover_description;
}

INSTANTIATE_TEST_SUITE_P(Catalog, EffectTakenOut,
                         ::testing::Values(TakenOut{"standby_power_error", 1.5, "depends on"},
                                           TakenOut{"supply_sag", 0.5, "battery voltage"},
                                           TakenOut{"wheel_radius_error", 0.05, "goes with wheel_radius_m"}),
                         [](const auto& taken) { return taken.param.effect; });

TEST(ShrinkInterval, FromOneHeldOutRunIsNotAPoint) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(testing::blind_day("rolling_resistance", 0.01, 0, 6, 31), {.bootstrap = 200});
  ASSERT_FALSE(d.causes.empty()) << verdict_name(d.verdict);
  const EnergyGap& energy = d.gap.energy;
  EXPECT_LT(energy.shrink_interval_95.first, energy.shrink_fraction - 0.005);
  EXPECT_LE(energy.shrink_interval_95.second, 1.0);
  EXPECT_GE(energy.shrink_interval_95.second, energy.shrink_fraction);
}

}  // namespace
}  // namespace joulepath
