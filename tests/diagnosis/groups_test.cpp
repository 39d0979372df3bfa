#include "diagnosis/evidence/groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"
#include "tests/support/blind_day.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr double kRolling = 0.008;

/// Runs of a robot with a rolling resistance that its file does not have. At a given load it is a friction
/// torque of c N r, which the simulation uses.
Dataset rolling_day(const std::vector<double>& payloads_kg, const testing::LogNoise& noise) {
  Dataset dataset{.robot = testing::nomad()};
  dataset.robot.uncertainty = {{"friction_torque", 0.03}, {"torque_constant", 0.01}, {"resistance", 0.02}};
  unsigned seed = 7;
  for (double payload_kg : payloads_kg) {
    Robot real = dataset.robot;
    const double load_N = 0.5 * kGravity_m_s2 * real.total_mass_kg(payload_kg);
    for (Side side : kSides)
      real.motor[side].friction_torque_Nm += kRolling * load_N * real.geometry.wheel_radius_m[side];
    const double kind = seed % 4;
    const auto law = testing::swinging(0.35 + 0.05 * kind, 0.1, 0.8 + 0.2 * kind, 0.1 * kind);
    dataset.runs.push_back(
        testing::synthetic_run(real, "run_" + std::to_string(seed), 15, payload_kg, law, noise, seed));
    dataset.runs.back().start_time_s = 30.0 * seed;
    ++seed;
  }
  return dataset;
}

bool group_holds(const Cause& cause, const std::string& effect) {
  return cause.effect.name == effect ||
         std::count(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end(), effect) > 0;
}

/// Of the sets {a, b}, {a}, {b} and none each contributes once to "a or b".
TEST(Group, ProbabilityThatOneOfItsMembersIsThereIsAProbability) {
  Equations equations;
  equations.candidates = {Candidate{.shape = {.name = "rolling_resistance"}},
                          Candidate{.shape = {.name = "coulomb_friction"}}};
  const std::vector<Explanation> explanations{{.candidates = {0, 1}, .score = 5},
                                              {.candidates = {0}, .score = 4},
                                              {.candidates = {1}, .score = 4},
                                              {}};
  Inclusion inclusion;
  inclusion.add(equations, explanations);
  const auto each = inclusion.of_each();
  const double any = inclusion.of_any({"rolling_resistance", "coulomb_friction"});
  EXPECT_GT(each.at("rolling_resistance") + each.at("coulomb_friction"), 1.0);
  EXPECT_LE(any, 1.0);
  const double w = kScoreFlattening;
  EXPECT_NEAR(any, 1 - 1 / (std::exp(5 * w) + 2 * std::exp(4 * w) + 1), 1e-12);
  EXPECT_NEAR(inclusion.of("coulomb_friction"), each.at("coulomb_friction"), 1e-12);
}

/// Two choices of runs favour one law each: neither is likely enough for a name, both together are.
TEST(Group, HoldsTheLawsThatRunsFavourByTurns) {
  Equations equations;
  equations.candidates = {Candidate{.shape = {.name = "rolling_resistance"}},
                          Candidate{.shape = {.name = "coulomb_friction"}},
                          Candidate{.shape = {.name = "viscous_friction"}}};
  const auto favouring = [](int law) {
    std::vector<Explanation> sets{
        {.candidates = {0}}, {.candidates = {1}}, {.candidates = {2}, .score = -400}};
    sets[static_cast<std::size_t>(law)].score = 400;
    std::ranges::stable_sort(sets, std::ranges::greater{}, &Explanation::score);
    return sets;
  };
  Inclusion inclusion;
  inclusion.add(equations, favouring(0), 0.6);
  inclusion.add(equations, favouring(1), 0.4);
  const std::vector<StandIn> rivals = likely_rivals(equations, favouring(0), 0, inclusion, {});
  ASSERT_EQ(rivals.size(), 1u);
  EXPECT_EQ(rivals[0].label, "coulomb_friction");
  EXPECT_NEAR(std::exp(-0.5 * kScoreFlattening * rivals[0].loss_more), 0.4 / 0.6, 1e-9);
  Inclusion sure;
  sure.add(equations, favouring(0));
  EXPECT_TRUE(likely_rivals(equations, favouring(0), 0, sure, {}).empty());
}

/// Rolling resistance beside a slope, which the runs cannot tell from Coulomb friction, is no unknown cause.
TEST(Group, OfLawsThatRunsFavourByTurnsIsNamed) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(testing::blind_day("--effect rolling_resistance,floor_slope --robot nomad "
                                                  "--protocol 12 --level 1 --seed 8406711331452625463"),
                               {.bootstrap = 0});
  ASSERT_EQ(d.causes.size(), 2u) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes[0].effect.name, "floor_slope");
  EXPECT_TRUE(group_holds(d.causes[1], "rolling_resistance"));
  EXPECT_TRUE(group_holds(d.causes[1], "coulomb_friction"));
  EXPECT_LT(d.causes[1].probability, 0.7);
}

TEST(Group, OnePayloadDoesNotTellRollingResistanceFromCoulombFriction) {
  const Diagnosis d =
      diagnose(rolling_day(std::vector<double>(8, 5.0), {0.002, 0.005, 0.01}), {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.verdict, Verdict::ambiguous);
  EXPECT_TRUE(group_holds(d.causes[0], "rolling_resistance"));
  EXPECT_TRUE(group_holds(d.causes[0], "coulomb_friction"));
  EXPECT_LT(d.causes[0].probability, 0.6);
  const auto ranked = std::ranges::find(d.ranking, d.causes[0].effect.name, &RankedEffect::effect);
  ASSERT_NE(ranked, d.ranking.end());
  EXPECT_NEAR(d.causes[0].probability, ranked->probability, 1e-12);
  EXPECT_FALSE(d.pinned_combination.empty());
  EXPECT_FALSE(d.corrected_robot.has_value());
  EXPECT_TRUE(std::any_of(d.notes.begin(), d.notes.end(),
                          [](const std::string& n) { return n.find("one payload") != std::string::npos; }));
}

TEST(Group, TwoPayloadsSeparateThemAlsoWithoutNoise) {
  const Diagnosis d = diagnose(rolling_day({0, 8, 0, 8, 0, 8, 0, 8, 0, 8}, {}), {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.verdict, Verdict::explained);
  EXPECT_EQ(d.causes[0].effect.name, "rolling_resistance");
  EXPECT_TRUE(d.causes[0].indistinguishable_from.empty());
  EXPECT_NEAR(d.causes[0].parameters[0].value, kRolling, 0.02 * kRolling);
  EXPECT_EQ(diagnosis_json(d).find("nan"), std::string::npos);
  EXPECT_EQ(diagnosis_json(d).find("null"), std::string::npos);
}

TEST(Group, WithoutVoltagesMagnetAndCurrentSensorAreAGroup) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = testing::blind_day("torque_constant_error", 0.1, 0, 12, 77);
  for (auto& run : dataset.runs) {
    run.log.motor_voltage_V = {};
    run.log.battery_voltage_V.clear();
    run.log.battery_current_A.clear();
  }
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  ASSERT_FALSE(d.causes.empty()) << verdict_name(d.verdict);
  EXPECT_EQ(d.verdict, Verdict::ambiguous);
  EXPECT_TRUE(group_holds(d.causes[0], "torque_constant_error"));
  EXPECT_TRUE(group_holds(d.causes[0], "current_sensor_gain"));
}

}  // namespace
}  // namespace joulepath
