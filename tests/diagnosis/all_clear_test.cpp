#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

Dataset quiet_day(const std::string& options) {
  return testing::blind_day(options + " --seed 12 --label none");
}

/// Battery power and odometry only: the most common log.
Dataset battery_only(Dataset dataset, bool battery = true) {
  for (Run& run : dataset.runs) {
    Trajectory& log = run.log;
    log.motor_voltage_V = {}, log.motor_current_A = {};
    log.gyro_yaw_rate_rad_s.clear(), log.position_x_m.clear(), log.position_y_m.clear();
    log.heading_rad.clear();
    if (!battery) log.battery_voltage_V.clear(), log.battery_current_A.clear();
  }
  return dataset;
}

TEST(AllClear, ReportsTheDetectableGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis d = diagnose(quiet_day("--effect none --protocol 24"), {.bootstrap = 20});
  ASSERT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
  EXPECT_GT(d.gap.energy.detectable_percent, 0.0);
  EXPECT_LT(d.gap.energy.detectable_percent, 10.0);
  EXPECT_EQ(d.leftover_share, 0.0) << "no unknown cause has a part of no gap";
}

TEST(AllClear, ALogWithoutPowerMeasurementsIsTooLittleData) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = quiet_day("--effect rolling_resistance --size 0.01 --protocol 12");
  const Diagnosis d = diagnose(battery_only(day, false), {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::too_little_data) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
}

/// Constants whose stated errors cover a gap leave no cause, and the gap is not called unseen.
TEST(AllClear, SaysWhichConstantCoversAGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset day = quiet_day("--effect dragging_wheel --size 0.02 --protocol 12");
  day.robot.uncertainty["friction_torque"] = 0.5;
  const Diagnosis d = diagnose(day, {.bootstrap = 0});
  EXPECT_TRUE(d.causes.empty());
  EXPECT_GT(d.gap.energy.before_percent, 2 * d.gap.energy.noise_floor_percent);
  EXPECT_NE(d.notes.back().find("within the uncertainty of the robot file's constants (friction_torque_Nm"),
            std::string::npos)
      << d.notes.back();
  day = quiet_day("--effect none --protocol 12");
  day.robot.uncertainty["friction_torque"] = 0.5;
  const Diagnosis silent = diagnose(day, {.bootstrap = 0});
  EXPECT_EQ(silent.notes.back().find("within the uncertainty"), std::string::npos) << silent.notes.back();
}

/// A mean over effects hides those that show late: an all-clear names each with the size from which it shows,
/// and a day with half as much again is none.
TEST(AllClear, NamesTheEffectsThatShowLate) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Diagnosis silent = diagnose(quiet_day("--effect none --protocol 12"), {.bootstrap = 20});
  ASSERT_EQ(silent.verdict, Verdict::no_gap) << verdict_name(silent.verdict);
  const std::vector<HardToSee>& hard = silent.gap.energy.hard_to_see;
  ASSERT_FALSE(hard.empty());
  EXPECT_NE(silent.notes.back().find("would show only above 3 %: "), std::string::npos)
      << silent.notes.back();
  for (const HardToSee& one : hard) {
    EXPECT_NE(silent.notes.back().find(one.effect + " (from "), std::string::npos) << one.effect;
    EXPECT_GT(one.detectable_percent, silent.gap.energy.detectable_percent) << one.effect;
    EXPECT_LE(one.detectable_percent, kGreatestUnseen_percent) << one.effect;
  }
  const auto coulomb = std::ranges::find(hard, "coulomb_friction", &HardToSee::effect);
  ASSERT_NE(coulomb, hard.end());
  Diagnosis more;
  for (double torque_Nm = 0.01; more.gap.energy.before_percent < 1.5 * coulomb->detectable_percent;
       torque_Nm *= 1.2) {
    ASSERT_LT(torque_Nm, 1.0);
    more = diagnose(quiet_day("--effect coulomb_friction --protocol 12 --size " + std::to_string(torque_Nm)),
                    {.bootstrap = 20});
  }
  EXPECT_TRUE(more.verdict != Verdict::no_gap && more.verdict != Verdict::too_little_data)
      << verdict_name(more.verdict);
}

/// Calibration errors within their uncertainty take up a gap that is larger than what the runs would have
/// shown of an effect: no smaller size may be stated.
TEST(AllClear, StatesNoSizeBelowTheMeasuredGap) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = testing::blind_day(
      "--effect gear_efficiency --size 0.02 --protocol 12 --level 0 --seed 4495434890916876233 --label "
      "none");
  const Diagnosis d = diagnose(day, {.bootstrap = 20, .without = {"gear_efficiency"}});
  ASSERT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
  ASSERT_GT(d.gap.energy.before_percent, d.gap.energy.detectable_percent);
  char size[32];
  std::snprintf(size, sizeof size, "no gap above %.2g %%", d.gap.energy.before_percent);
  EXPECT_TRUE(std::ranges::any_of(d.notes, [&](const std::string& note) { return note.starts_with(size); }));
}

/// A resistance shows in the battery's power and is localized to driving phases, but to no wheel.
TEST(AllClear, BatteryPowerAloneShowsAGapAndWhereItLies) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = quiet_day("--effect rolling_resistance --size 0.015 --protocol 24");
  const Diagnosis d = diagnose(battery_only(day), {.bootstrap = 20});
  EXPECT_NE(d.verdict, Verdict::no_gap);
  EXPECT_GT(d.gap.energy.before_percent, 5.0);
  EXPECT_TRUE(std::ranges::any_of(d.where, [](const WhereCell& cell) { return cell.axis == "phase"; }));
  EXPECT_TRUE(std::ranges::none_of(d.where, [](const WhereCell& cell) { return cell.axis == "wheel"; }));
}

/// Battery power is quadratic in the torque: one large effect must not turn into three.
TEST(AllClear, BatteryPowerAloneNamesNoSecondCause) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset day = quiet_day("--effect rolling_resistance --size 0.012 --protocol 24");
  for (auto& run : day.runs) run.log.motor_voltage_V = {}, run.log.motor_current_A = {};
  const Diagnosis d = diagnose(day, {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes.front().effect.name, "rolling_resistance");
}

/// A friction that widens the held-out gap is no cause beside the slip that the pose shows.
TEST(AllClear, BatteryPowerAloneKeepsTheNameThatHoldsOut) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset day = testing::blind_day(
      "--effect wheel_slip --robot tug --protocol 24 --level 0 --seed 6083549644663448309 --share 1");
  for (auto& run : day.runs) {
    run.log.motor_voltage_V = {}, run.log.motor_current_A = {};
    run.log.gyro_yaw_rate_rad_s.clear();
  }
  const Diagnosis d = diagnose(day, {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict);
  EXPECT_EQ(d.causes.front().effect.name, "wheel_slip");
}

/// The payload changes at a stop in one step; no sample has an intermediate value.
TEST(Payload, AStepWithinARunIsNotInterpolated) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset day = quiet_day("--effect none --protocol 6");
  std::vector<double>& payload = day.runs[0].log.payload_kg;
  payload.resize(day.runs[0].log.size());
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = 2 * i < payload.size() ? 0.0 : 8.0;
  const RunsByUse runs = sort_runs(day);
  ASSERT_EQ(runs.signals.front().run_index, 0u);
  for (double kg : runs.signals.front().payload_kg) EXPECT_TRUE(kg == 0.0 || kg == 8.0) << kg;
}

}  // namespace
}  // namespace joulepath
