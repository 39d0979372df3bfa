#include <gtest/gtest.h>

#include <string>

#include "diagnosis/checks/survey.hpp"
#include "diagnosis/evidence/equations.hpp"
#include "diagnosis/evidence/refit.hpp"
#include "diagnosis/prediction/nuisance.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

/// A test day of six runs of the benchmark's plant, with an effect and its size, or `none`.
Dataset six_runs(const std::string& effect) {
  return testing::blind_day("--effect " + effect + " --protocol 6 --seed 31");
}

/// Wheel speeds and currents alone, as on many real robots.
Dataset speeds_and_currents(const std::string& effect) {
  Dataset dataset = six_runs(effect);
  for (auto& run : dataset.runs) {
    Trajectory& log = run.log;
    log.motor_voltage_V = {};
    for (std::vector<double>* channel :
         {&log.battery_voltage_V, &log.battery_current_A, &log.gyro_yaw_rate_rad_s, &log.position_x_m,
          &log.position_y_m, &log.heading_rad})
      channel->clear();
  }
  return dataset;
}

TEST(OddRuns, ARunAtRestThroughoutIsNoObstacle) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = speeds_and_currents("none");
  auto& still = dataset.runs[1];
  for (Side side : kSides) {
    still.log.wheel_speed_rad_s[side].assign(still.log.size(), 0.0);
    still.log.motor_current_A[side].assign(still.log.size(), 0.0);
  }
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_TRUE(d.causes.empty()) << d.causes.front().effect.name;
}

/// Derivatives by a shape parameter at the end of its accepted range are one-sided.
TEST(OddRuns, AShapeParameterAtItsBoundCanBeLinearized) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset dataset = speeds_and_currents("none");
  const std::vector<Nuisance> nuisances = calibration_nuisances(dataset.robot);
  const std::vector<RunSignals> signals = read_signals({.dataset = &dataset, .runs = {0, 1, 2}}, 0.0);
  for (const double trail_m : {0.005, 10.0}) {
    Candidate swivel;
    for (const Candidate& candidate : catalog_candidates(dataset.robot))
      if (candidate.shape.name == "caster_swivel") swivel = candidate;
    swivel.shape.parameters["trail_m"] = trail_m;
    const ModelState state{.nuisance_fraction = std::vector<double>(nuisances.size()),
                           .effects = {{.candidate = swivel, .amplitude = {0.5}}}};
    const Equations equations =
        build_equations(signals, dataset.robot, nuisances, state, {},
                        {.whole_catalog = false, .dictionary = false, .forms = Forms::none});
    for (const RunEquations& run : equations.runs) EXPECT_TRUE(run.gram.allFinite()) << trail_m;
  }
}

/// The same day with and without voltages: V = R i + Kv n q' gives nearly the same joules.
TEST(OddRuns, WithoutVoltagesEnergiesAreThoseOfTheCurrents) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const std::string effect = "rolling_resistance --size 0.01";
  const EnergyGap with = diagnose(six_runs(effect), {.bootstrap = 20}).gap.energy;
  const EnergyGap without = diagnose(speeds_and_currents(effect), {.bootstrap = 20}).gap.energy;
  EXPECT_GT(with.before_percent, 10);
  EXPECT_NEAR(without.before_percent, with.before_percent, 0.05 * with.before_percent);
  EXPECT_NEAR(without.before_J, with.before_J, 0.05 * with.before_J);
}

/// A finding that all runs share is reported once.
TEST(OddRuns, TheSameArtifactOfManyRunsIsOneText) {
  Dataset dataset;
  dataset.runs.resize(5);
  for (int k = 1; k <= 5; ++k)
    dataset.artifacts.push_back({"unsigned", "run_" + std::to_string(k), "motor_current_left_A", "no sign"});
  dataset.artifacts.push_back({"clock jump", "run_2", "", "0.3 s"});
  EXPECT_EQ(artifact_texts(dataset),
            (std::vector<std::string>{"all 5 runs: unsigned in motor_current_left_A: no sign",
                                      "run_2: clock jump: 0.3 s"}));
}

/// The usual size of an effect grows with the robot: catalog sizes are those of the Nomad.
TEST(Candidates, UsualSizesGrowWithTheRobotsOwnResistance) {
  const Robot nomad = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  Robot heavy = nomad;
  for (Side side : kSides) heavy.motor[side].friction_torque_Nm *= 10;
  heavy.inertia.chassis_mass_kg *= 10;
  const auto step = [](const Robot& robot, const std::string& effect) {
    for (const Candidate& candidate : catalog_candidates(robot))
      if (candidate.shape.name == effect) return candidate.step[0];
    return 0.0;
  };
  for (const char* effect :
       {"coulomb_friction", "turning_scrub", "dragging_wheel", "current_sensor_offset", "quadratic_drag"}) {
    const double typical = find_effect(effect)->parameters.front().typical;
    EXPECT_NEAR(step(nomad, effect), typical, 0.05 * typical) << effect;
    EXPECT_NEAR(step(heavy, effect), 10 * step(nomad, effect), 1e-9) << effect;
  }
  for (const char* effect : {"rolling_resistance", "wheel_radius_error", "torque_constant_error"})
    EXPECT_DOUBLE_EQ(step(heavy, effect), find_effect(effect)->parameters.front().typical) << effect;
}

}  // namespace
}  // namespace joulepath
