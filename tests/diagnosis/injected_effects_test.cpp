#include <gtest/gtest.h>

#include <string>

#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

/// An effect and a size at which it must be found, in the unit of its first parameter.
struct Injection {
  std::string effect{};
  double size{};
};

void PrintTo(const Injection& injection, std::ostream* out) { *out << injection.effect; }

using joulepath::testing::blind_day;
using joulepath::testing::have_blind_plant;

class InjectedEffect : public ::testing::TestWithParam<Injection> {};

TEST_P(InjectedEffect, IsNamedOrInTheNamedGroup) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(blind_day(GetParam().effect, GetParam().size, 0, 12, 4242), {.bootstrap = 50});
  ASSERT_FALSE(d.causes.empty()) << verdict_name(d.verdict);
  bool named = false;
  for (const Cause& cause : d.causes) {
    named |= cause.effect.name == GetParam().effect;
    for (const std::string& other : cause.indistinguishable_from)
      named |= other.rfind(GetParam().effect, 0) == 0;
  }
  EXPECT_TRUE(named) << "named instead: " << d.causes.front().effect.name;
}

INSTANTIATE_TEST_SUITE_P(
    Catalog, InjectedEffect,
    ::testing::Values(Injection{"rolling_resistance", 0.01}, Injection{"floor_patch", 0.03},
                      Injection{"stribeck_friction", 0.15}, Injection{"coulomb_friction", 0.06},
                      Injection{"dragging_wheel", 0.08}, Injection{"direction_dependent_friction", 0.1},
                      Injection{"viscous_friction", 0.008}, Injection{"gear_efficiency", 0.12},
                      Injection{"turning_scrub", 0.8}, Injection{"caster_swivel", 1.5},
                      Injection{"quadratic_drag", 6.0}, Injection{"wheel_slip", 250.0},
                      Injection{"payload_mass_error", 0.3}, Injection{"center_of_mass_offset", 0.06},
                      Injection{"yaw_inertia_error", 0.8}, Injection{"wheel_radius_error", 0.03},
                      Injection{"wheel_radius_mismatch", 0.02}, Injection{"track_width_error", 0.06},
                      Injection{"floor_slope", 0.008}, Injection{"winding_resistance_error", 0.2},
                      Injection{"winding_heating", 0.3}, Injection{"torque_constant_error", 0.06},
                      Injection{"driver_voltage_drop", 0.4}, Injection{"standby_power_error", 3.0},
                      Injection{"supply_sag", 0.4}, Injection{"current_sensor_offset", 0.06},
                      Injection{"current_sensor_gain", 0.1}, Injection{"time_misalignment", 0.08}),
    [](const ::testing::TestParamInfo<Injection>& injected) { return injected.param.effect; });

/// This robot coasts against so much friction that regeneration returns only a fifth of the materiality
/// floor. The gap is within the noise: the effect is told as small, however decisive its evidence.
TEST(SmallEffect, IsListedBelowTheMaterialityFloorWithStrongEvidence) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(blind_day("regeneration_error", 0.6, 0, 12, 4242), {.bootstrap = 50});
  EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
  ASSERT_EQ(d.below_materiality.size(), 1u);
  EXPECT_EQ(d.below_materiality.front().effect, "regeneration_error");
}

/// An unknown term beside a name can stand for it. Then the name's size is found without the term.
TEST(SmallEffect, HasASizeWhereAnUnknownTermCouldStandForIt) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  struct Day {
    double size;
    int runs, seed;
  };
  for (const Day& day : {Day{-0.3, 6, 1}, Day{-0.3, 12, 4}, Day{0.3, 12, 1}}) {
    const Diagnosis d =
        diagnose(blind_day("yaw_inertia_error", day.size, 0, day.runs, day.seed), {.bootstrap = 0});
    ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
    EXPECT_EQ(d.causes.front().effect.name, "yaw_inertia_error");
    const auto& [least, most] = d.causes.front().parameters.front().interval_95;
    EXPECT_LT(least, day.size);
    EXPECT_GT(most, day.size);
  }
}

TEST(ForeignCause, IsNeverCalledExplainedWhenItsGapStays) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const Injection& foreign : {Injection{"air_draft", 3.0}, Injection{"eddy_brake", 0.2}}) {
    const Diagnosis d = diagnose(blind_day(foreign.effect, foreign.size, 0, 24, 701), {.bootstrap = 50});
    EXPECT_TRUE(d.verdict == Verdict::unexplained || d.verdict == Verdict::partly_explained)
        << foreign.effect << ": " << verdict_name(d.verdict);
    EXPECT_LT(d.gap.energy.noise_floor_percent, 0.25 * d.gap.energy.before_percent) << foreign.effect;
  }
}

TEST(NullDatasets, NameNoEffect) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  int alarms = 0;
  for (int seed = 1; seed <= 4; ++seed)
    alarms += diagnose(blind_day("none", 0, seed % 2, 12, 900 + seed), {.bootstrap = 50}).verdict !=
              Verdict::no_gap;
  EXPECT_EQ(alarms, 0);
}

}  // namespace
}  // namespace joulepath
