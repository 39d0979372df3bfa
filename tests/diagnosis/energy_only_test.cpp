#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "diagnosis/energies_only/energy_run.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

Run run_of(const PrescribedMotion& motion, double payload_kg, std::size_t index) {
  Run run{.name = "runs[" + std::to_string(index) + "]"};
  run.motion = motion;
  run.payload = {{0.0, payload_kg}};
  run.payload_known = true;
  run.measured_energy_J = Sided<double>{1.0, 1.0};
  return run;
}

PrescribedMotion steady(double speed_m_s) {
  return {.profile = MotionProfile::constant_speed, .speed_m_s = speed_m_s, .distance_m = 3.0};
}

PrescribedMotion lane(double speed_m_s, double acceleration_m_s2) {
  return {.profile = MotionProfile::trapezoid,
          .acceleration_m_s2 = acceleration_m_s2,
          .speed_m_s = speed_m_s,
          .distance_m = 4.0};
}

PrescribedMotion bend(double radius_m, double angle_rad) {
  return {.profile = MotionProfile::arc,
          .acceleration_m_s2 = 0.25,
          .speed_m_s = 0.5,
          .radius_m = radius_m,
          .angle_rad = angle_rad};
}

/// A test day with a wattmeter only: the energy of a plant, with an error of `scatter` per run.
Dataset wattmeter_day(const std::vector<EffectSetting>& effects, double scatter, unsigned seed) {
  Dataset dataset{.file = "wattmeter.yaml", .robot = testing::nomad()};
  dataset.robot.uncertainty = {{"friction_torque_Nm", 0.01}, {"resistance_ohm", 0.01}};
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (const double payload_kg : {0.0, 5.0, 10.0})
    for (const PrescribedMotion& motion : {steady(0.2), steady(0.5), steady(0.9), lane(0.6, 0.2),
                                           lane(0.9, 0.5), bend(0.8, 2.0), bend(0.8, -2.0)})
      dataset.runs.push_back(run_of(motion, payload_kg, dataset.runs.size()));
  const std::vector<EnergyRun> runs = energy_runs(dataset);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const RunJoules joules = joules_of(runs[r].motion, {.robot = dataset.robot, .effects = effects});
    const double factor = 1 + scatter * normal(engine);
    dataset.runs[r].measured_energy_J =
        Sided<double>{joules.wheel_J.left * factor, joules.wheel_J.right * factor};
  }
  return dataset;
}

TEST(EnergyOnly, ACurveIsNamedByTheSideToWhichItTurns) {
  Dataset dataset{.robot = testing::nomad()};
  dataset.runs = {run_of(bend(1.0, 1.5), 0, 0), run_of(bend(1.0, -1.5), 0, 1), run_of(steady(0.5), 0, 2)};
  const std::vector<EnergyRun> runs = energy_runs(dataset);
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].path, "curve to the left");
  EXPECT_EQ(runs[1].path, "curve to the right");
  EXPECT_EQ(runs[2].path, "straight");
}

TEST(EnergyOnly, SteadySpeedTakesWhatTheClosedFormSays) {
  Dataset dataset{.robot = testing::nomad()};
  dataset.runs.push_back(run_of(steady(0.5), 5.0, 0));
  const EnergyRun run = energy_runs(dataset).front();
  const RunJoules joules = joules_of(run.motion, {.robot = dataset.robot});
  for (Side side : kSides) {
    const Motor& motor = dataset.robot.motor[side];
    const double speed_rad_s = 0.5 / 0.1;
    const double current_A = (motor.friction_torque_Nm + 0.0017 * speed_rad_s) / (0.069 * 24.9);
    const double power_W = 2.74 * current_A * current_A + 0.069 * 24.9 * speed_rad_s * current_A;
    EXPECT_NEAR(joules.wheel_J[side], power_W * 6.0, 1e-6 * power_W * 6.0);
  }
}

TEST(EnergyOnly, ResistanceThatGrowsWithTheLoadLeadsTheCandidatesAndIsNotNamed) {
  const Dataset dataset =
      wattmeter_day({{.name = "rolling_resistance", .parameters = {{"coefficient", 0.015}}}}, 0.01, 1);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 200});
  EXPECT_EQ(d.verdict, Verdict::too_little_data) << verdict_name(d.verdict);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_FALSE(d.corrected_robot);
  ASSERT_FALSE(d.ranking.empty());
  EXPECT_EQ(d.ranking.front().effect, "rolling_resistance");
  EXPECT_LT(d.gap.energy.bias_before_percent, -10);
  EXPECT_EQ(d.gap.energy.after_J, d.gap.energy.before_J);
  EXPECT_GE(d.ceiling_shrink_fraction, 0.5);
  double before_percent = 0, after_percent = 0;
  for (const std::string& note : d.notes)
    std::sscanf(note.c_str(), "the best candidates turn a gap of %lf %% on held-out runs into one of %lf %%",
                &before_percent, &after_percent);
  EXPECT_NEAR(before_percent, d.gap.energy.before_percent, 0.01 * before_percent);
  EXPECT_GT(after_percent, 0.3) << "the readings' scatter of 1 % stays";
  EXPECT_LT(after_percent, 2.0);
}

TEST(EnergyOnly, SharesOfEachAxisAddUpToOneAndTheHeavyRunsHoldMost) {
  const Dataset dataset =
      wattmeter_day({{.name = "rolling_resistance", .parameters = {{"coefficient", 0.015}}}}, 0.01, 2);
  std::map<std::string, double> sum, payload;
  for (const WhereCell& cell : diagnose(dataset, {.bootstrap = 50}).where) {
    sum[cell.axis] += cell.share_of_gap;
    if (cell.axis == "payload") payload[cell.value] = cell.share_of_gap;
  }
  for (const char* axis : {"path", "payload", "acceleration", "wheel", "run"})
    EXPECT_NEAR(sum[axis], 1.0, 1e-9) << axis;
  EXPECT_GT(payload["10 kg"], payload["5 kg"]);
  EXPECT_GT(payload["5 kg"], payload["0 kg"]);
}

TEST(EnergyOnly, ScatterAloneIsNoGap) {
  for (unsigned seed = 10; seed < 16; ++seed) {
    const Diagnosis d = diagnose(wattmeter_day({}, 0.01, seed), {.bootstrap = 100});
    EXPECT_EQ(d.verdict, Verdict::no_gap) << seed << ": " << verdict_name(d.verdict);
    EXPECT_FALSE(d.leftover_significant) << seed;
  }
}

TEST(EnergyOnly, ThreeRunsGetAPlaceAndCandidatesButNoName) {
  Dataset dataset =
      wattmeter_day({{.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}}, 0.005, 3);
  dataset.runs.resize(3);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 50});
  EXPECT_EQ(d.verdict, Verdict::too_little_data);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_FALSE(d.where.empty());
  EXPECT_FALSE(d.ranking.empty());
}

TEST(EnergyOnly, RunsWithoutALogDoNotDependOnTheirOrder) {
  Dataset dataset =
      wattmeter_day({{.name = "rolling_resistance", .parameters = {{"coefficient", 0.015}}}}, 0.01, 4);
  const Diagnosis forward = diagnose(dataset, {.bootstrap = 50});
  std::ranges::reverse(dataset.runs);
  const Diagnosis backward = diagnose(dataset, {.bootstrap = 50});
  EXPECT_EQ(forward.verdict, backward.verdict);
  EXPECT_NEAR(forward.gap.energy.before_J, backward.gap.energy.before_J, 1e-6 * forward.gap.energy.before_J);
  ASSERT_EQ(forward.ranking.size(), backward.ranking.size());
  for (std::size_t k = 0; k < forward.ranking.size(); ++k)
    EXPECT_EQ(forward.ranking[k].effect, backward.ranking[k].effect);
}

TEST(EnergyOnly, ThePapersTablesHaveAGapAPlaceAndCandidatesButNoName) {
  for (const char* file : {"tables_4_and_6.yaml", "tables_4_and_6_sure.yaml"}) {
    const Diagnosis d = diagnose(read_dataset(std::string(JOULEPATH_SOURCE_DIR "/scenarios/paper/") + file),
                                 {.bootstrap = 100});
    EXPECT_NE(d.verdict, Verdict::explained) << file;
    EXPECT_NE(d.verdict, Verdict::no_gap) << file;
    EXPECT_TRUE(d.causes.empty()) << file;
    EXPECT_FALSE(d.corrected_robot) << file;
    EXPECT_FALSE(d.ranking.empty()) << file;
    const auto unloaded = std::ranges::find_if(
        d.where, [](const WhereCell& cell) { return cell.axis == "payload" && cell.value == "0 kg"; });
    ASSERT_NE(unloaded, d.where.end()) << file;
    EXPECT_GT(unloaded->bias_percent.value_or(0), 0) << file;
  }
}

TEST(EnergyOnly, AMotionThatCannotBeDrivenIsToldWithItsPlace) {
  Dataset dataset{.robot = testing::nomad()};
  dataset.runs.push_back(run_of({.profile = MotionProfile::trapezoid,
                                 .acceleration_m_s2 = 0.1,
                                 .speed_m_s = 1.0,
                                 .start_speed_m_s = 1.0,
                                 .distance_m = 0.1},
                                0.0, 0));
  dataset.runs.front().mark = {"day.yaml", 4, 5};
  try {
    static_cast<void>(energy_runs(dataset));
    FAIL() << "taken";
  } catch (const ConfigError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("day.yaml:4:5: runs[0].motion.distance_m", 0), 0u)
        << error.what();
  }
}

TEST(EnergyOnly, ReadsWattHoursOfTheBatteryAsJoules) {
  Dataset dataset{.robot = testing::nomad()};
  dataset.runs = {run_of(steady(0.5), 0, 0)};
  dataset.runs[0].battery_energy_Wh = 0.5;
  EXPECT_EQ(energy_runs(dataset).front().battery_J, 1800.0);
}

}  // namespace
}  // namespace joulepath
