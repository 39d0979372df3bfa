#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/standstill_cuts.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

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
                                           TakenOut{"current_sensor_offset", -0.01,
                                                    "constant (current reading)"},
                                           TakenOut{"current_sensor_gain", 0.1, "current (current reading)"},
                                           TakenOut{"gear_efficiency", 0.1, "motor torque (current)"},
                                           TakenOut{"wheel_radius_error", 0.05, "goes with wheel_radius_m"}),
                         [](const auto& taken) { return taken.param.effect; });

/// An effect that no law of the catalog describes, at 0.7 of a large size, as an option of the plant.
class ForeignEffect : public ::testing::TestWithParam<std::string> {};

TEST_P(ForeignEffect, WithEvidenceIsNoAllClear) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d =
      diagnose(testing::blind_day("--share 0.7 --protocol 24 --effect " + GetParam()), {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::unexplained) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_TRUE(d.leftover_significant);
}

// It differs between the runs more than any friction law.
INSTANTIATE_TEST_SUITE_P(Development, ForeignEffect,
                         ::testing::Values("cold_grease --level 1 --seed 774797932166278282"),
                         [](const auto& one) { return one.param.substr(0, one.param.find(' ')); });

/// A load that swings takes no energy on the whole; what it does depends on accelerations that are over.
TEST(ForeignEffectWithMemory, OfASwingingLoadIsNoAllClear) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(
      testing::blind_day("--effect payload_slosh --size 0.3 --robot nomad --protocol 12 --level 0 --seed 5"),
      {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::unexplained) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_NE(d.leftover_description.find("past acceleration"), std::string::npos) << d.leftover_description;
}

/// Rolling resistance that no law describes is taken for Coulomb friction, whose strength no payload changes
/// so.
TEST(InexactForm, OfAFrictionThatGrowsWithThePayloadIsUnknown) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(testing::blind_day("rolling_resistance", 0.005, 0, 24, 31),
                               {.bootstrap = 20, .without = {"rolling_resistance"}});
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << verdict_name(d.verdict);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes.front().effect.name, "coulomb_friction");
  EXPECT_NE(d.leftover_description.find("payload (coulomb_friction)"), std::string::npos)
      << d.leftover_description;
}

/// A draft that grows all day pulls like a slope, whose strength no floor changes with the time.
TEST(InexactForm, OfAForceThatGrowsIsUnknown) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d =
      diagnose(testing::blind_day(
                   "--effect air_draft --robot small --protocol 12 --level 1 --seed 1838101856669714268"),
               {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::partly_explained) << verdict_name(d.verdict);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes.front().effect.name, "floor_slope");
  EXPECT_NE(d.leftover_description.find("time of day (floor_slope)"), std::string::npos)
      << d.leftover_description;
}

/// A day on which a hose that is led along tightens as the robot turns away from its first heading: each
/// wheel is braked by a torque that grows with that angle.
Dataset with_hose(Dataset day, double torque_Nm) {
  for (joulepath::Run& run : day.runs) {
    Trajectory& log = run.log;
    for (std::size_t i = 0; i < log.time_s.size(); ++i) {
      const double wound = std::exp(std::min(0.5 * std::abs(log.heading_rad[i] - log.heading_rad[0]), 2.0));
      for (const Side side : kSides) {
        const Motor& motor = day.robot.motor[side];
        const double speed_rad_s = log.wheel_speed_rad_s[side][i];
        const double more_A =
            std::tanh(speed_rad_s / 0.2) * torque_Nm * wound / motor.torque_per_ampere_Nm_A();
        log.motor_current_A[side][i] += more_A;
        log.motor_voltage_V[side][i] += motor.resistance_ohm * more_A;
      }
    }
  }
  return day;
}

/// Static friction at low speed and a slope were the names, after which 84 % of the energy gap was left.
TEST(NamesThatImitate, AreWithdrawnWhereTheyLeaveMostOfEveryGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const auto& [day, share] :
       {std::pair{"--robot warehouse --seed 4", 0.3}, {"--robot small --seed 5", 0.1}}) {
    const Dataset plain = testing::blind_day(std::string("--effect none --level 0 --protocol 12 ") + day);
    const Diagnosis d =
        diagnose(with_hose(plain, share * plain.robot.motor.left.friction_torque_Nm), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::unexplained) << verdict_name(d.verdict) << ", " << day;
    EXPECT_TRUE(d.causes.empty()) << day;
    EXPECT_GT(d.gap.energy.before_percent, 5) << day;
    EXPECT_TRUE(d.leftover_significant) << day;
  }
}

TEST(ShrinkInterval, FromSixRunsIsNotAPoint) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(testing::blind_day("rolling_resistance", 0.01, 0, 6, 31), {.bootstrap = 200});
  ASSERT_FALSE(d.causes.empty()) << verdict_name(d.verdict);
  const EnergyGap& energy = d.gap.energy;
  EXPECT_LT(energy.shrink_interval_95.first, energy.shrink_fraction - 0.005);
  EXPECT_LE(energy.shrink_interval_95.second, 1.0);
  EXPECT_GE(energy.shrink_interval_95.second, energy.shrink_fraction);
}

/// One payload all day: a strength that varies with it is the law's size, and no unknown cause.
TEST(InexactForm, OfAVariableThatNeverVariesIsNotTold) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset day =
      testing::blind_day("--effect viscous_friction --size 0.2 --seed 12 --level 1 --one-log --label none");
  day.runs = cut_at_standstill(std::move(day.runs), day.artifacts);
  const Diagnosis d = diagnose(day, {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes[0].effect.name, "viscous_friction");
  EXPECT_TRUE(d.unknowns.empty()) << d.leftover_description;
}

}  // namespace
}  // namespace joulepath
