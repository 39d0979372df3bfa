// Runs that no model of the other runs describes: one that drags, carries or climbs what nobody noted.
#include "diagnosis/correction/runs_apart.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

std::vector<RunPower> powers_with(std::vector<double> gaps_W) {
  std::vector<RunPower> powers;
  for (std::size_t r = 0; r < gaps_W.size(); ++r) powers.push_back({r, 20 + gaps_W[r], 20});
  return powers;
}

TEST(RunsApart, DifferFromEveryOtherRun) {
  using Runs = std::set<std::size_t>;
  const std::vector<double> small{0.1, -0.2, 0.3, 0.2, -0.1, 0.3, 0.2};
  const auto with = [&](std::vector<double> more) {
    std::vector<double> gaps = small;
    gaps.insert(gaps.end(), more.begin(), more.end());
    return powers_with(gaps);
  };
  EXPECT_EQ(runs_apart(with({}), 4, 0.1), Runs{});
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(runs_apart(with({sign * 10}), 4, 0.1), Runs{7}) << sign;
    EXPECT_EQ(runs_apart(with({sign * 10}), 4, 60), Runs{}) << "within the noise";
    EXPECT_EQ(runs_apart(with({sign * 0.9}), 2, 0.1), Runs{}) << "less than 5 % of the power";
    EXPECT_EQ(runs_apart(with({sign * 10, sign * 3}), 4, 0.1), Runs{}) << "the next one is too near";
    EXPECT_EQ(runs_apart(with({sign * 10, sign * 9}), 4, 0.1), Runs{}) << "two of nine are not one in ten";
  }
  std::vector<double> twenty(20, 0.2);
  twenty[3] = 8, twenty[11] = -9;
  EXPECT_EQ(runs_apart(powers_with(twenty), 4, 0.1), (Runs{3, 11}));
  EXPECT_EQ(runs_apart(powers_with({0.1, 0.1, 0.1, 10}), 4, 0.1), Runs{}) << "three others are too few";
}

/// Ten runs with payloads and turns; in one of them a further torque (N m) acts on both wheels. `rolling_Nm_kg`: a
/// friction in proportion to the load that the file does not have.
Dataset day(double odd_Nm, double rolling_Nm_kg) {
  Dataset dataset{.robot = testing::nomad()};
  for (unsigned r = 0; r < 10; ++r) {
    Robot real = dataset.robot;
    const double kind = r % 5, payload_kg = r % 2 == 0 ? 0 : 8;
    for (Side side : kSides)
      real.motor[side].friction_torque_Nm +=
          rolling_Nm_kg * real.total_mass_kg(payload_kg) + (r == 6 ? odd_Nm : 0.0);
    dataset.runs.push_back(testing::synthetic_run(
        real, "run_" + std::to_string(r), 12, payload_kg,
        testing::swinging((r % 3 == 0 ? -1 : 1) * (0.3 + 0.1 * kind), 0.1, 0.8 + 0.2 * kind, 0.2 * kind),
        {0.002, 0.005, 0.01}, r + 1));
  }
  return dataset;
}

TEST(RunsApart, AreNamedAndTheOthersJudged) {
  const Diagnosis d = diagnose(day(-0.2, 0), {.bootstrap = 20});
  ASSERT_EQ(d.runs_apart.size(), 1u);
  EXPECT_EQ(d.runs_apart[0].run, "run_6");
  EXPECT_LT(d.runs_apart[0].over_model_percent, -5);
  EXPECT_GT(d.runs_apart[0].share_of_gap, 0.5);
  EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
  EXPECT_LT(d.gap.energy.before_percent, 1.0);
  EXPECT_TRUE(std::ranges::none_of(d.where, [](const WhereCell& cell) { return cell.value == "run_6"; }));
}

TEST(RunsApart, DoNotHideACauseOfTheOthers) {
  const Diagnosis d = diagnose(day(0.4, 0.008 * 0.5 * kGravity_m_s2 * 0.1), {.bootstrap = 20});
  ASSERT_EQ(d.runs_apart.size(), 1u);
  EXPECT_EQ(d.runs_apart[0].run, "run_6");
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes[0].effect.name, "rolling_resistance");
  EXPECT_EQ(d.verdict, Verdict::explained) << verdict_name(d.verdict);
  EXPECT_TRUE(shrinks_notably(d.gap));
  EXPECT_GT(d.runs_apart[0].over_model_percent, 5);
  EXPECT_LT(d.gap.energy.after_percent, 1.0);
}

TEST(RunsApart, AreNoneWhereALawExplainsEveryRun) {
  EXPECT_TRUE(diagnose(day(0, 0.008 * 0.5 * kGravity_m_s2 * 0.1), {.bootstrap = 20}).runs_apart.empty());
}

}  // namespace
}  // namespace joulepath
