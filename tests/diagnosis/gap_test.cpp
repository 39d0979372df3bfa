// The energy gap of runs with two models, against sums over the samples.
#include "diagnosis/where/gap.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;

/// The robot as it is: more friction than the file says.
Robot worn() {
  Robot robot = nomad();
  for (Side side : kSides) robot.motor[side].friction_torque_Nm *= 1.2;
  return robot;
}

/// A short slow run, a long fast one and one with a payload.
std::vector<RunSignals> three_runs() {
  const auto run = [](const char* name, double duration_s, double payload_kg, double speed_m_s) {
    return testing::synthetic_run(worn(), name, duration_s, payload_kg,
                                  testing::swinging(speed_m_s, 0.1, 1.1, 0.3));
  };
  std::vector<RunSignals> signals;
  for (const Run& each : {run("slow", 8, 0, 0.3), run("fast", 20, 0, 0.8), run("loaded", 12, 10, 0.5)})
    signals.push_back(make_run_signals(each, signals.size(), nomad()));
  return signals;
}

double measured_J(const RunSignals& run) {
  return (run.motor_power_W.left.sum() + run.motor_power_W.right.sum()) * run.period_s;
}

double predicted_J(const RunSignals& run, const Robot& robot) {
  const Prediction p = predict(run, {.robot = robot});
  return (p.power_W.left.sum() + p.power_W.right.sum()) * run.period_s;
}

GapReport gap_between(const std::vector<RunSignals>& signals, const Robot& before, const Robot& after) {
  return measure_gap({.before_signals = signals,
                      .after_signals = signals,
                      .before = {.robot = before},
                      .after = ModelPoints(signals.size(), {.robot = after}),
                      .noise_floor_percent = 0.1,
                      .bootstrap = 50,
                      .fitted_signals = signals,
                      .fitted = {.robot = after}});
}

TEST(Gap, IsTheSumOverRunsOverTheirMeasuredEnergy) {
  const std::vector<RunSignals> signals = three_runs();
  double sum_J = 0, gap_J = 0;
  for (const RunSignals& run : signals) {
    EXPECT_GT(measured_J(run), 1.0);
    sum_J += measured_J(run);
    gap_J += predicted_J(run, nomad()) - measured_J(run);
  }
  ASSERT_LT(gap_J, 0) << "friction is missing in the model: it predicts too little for each run";
  const EnergyGap gap = gap_between(signals, nomad(), worn()).energy;
  EXPECT_NEAR(gap.before_J, -gap_J, 1e-9 * sum_J);
  EXPECT_NEAR(gap.before_percent, -100 * gap_J / sum_J, 1e-9);
  EXPECT_NEAR(gap.bias_before_percent, 100 * gap_J / sum_J, 1e-9);
  EXPECT_LT(gap.after_percent, 0.05 * gap.before_percent);
  EXPECT_NEAR(gap.shrink_fraction, 1 - gap.after_J / gap.before_J, 1e-12);
  EXPECT_LE(gap.shrink_interval_95.first, gap.shrink_fraction);
  EXPECT_GE(gap.shrink_interval_95.second, gap.shrink_fraction);
}

/// A change of the model that no signal gains from is no reason for a correction.
TEST(Gap, OfAnotherSignalShrinksWithTheRightModelOnly) {
  const std::vector<RunSignals> signals = three_runs();
  const auto points = [&](const Robot& robot) { return ModelPoints(signals.size(), {.robot = robot}); };
  Robot wider = nomad();
  wider.inertia.chassis_yaw_inertia_kg_m2 *= 1.05;
  EXPECT_TRUE(shrinks_a_signal(signals, points(nomad()), signals, points(worn())));
  EXPECT_FALSE(shrinks_a_signal(signals, points(nomad()), signals, points(nomad())));
  EXPECT_FALSE(shrinks_a_signal(signals, points(nomad()), signals, points(wider)));
}

/// Gaps of opposite signs cancel in the bias and not in the gap.
TEST(Gap, OfOppositeRunsIsNotTheirBias) {
  std::vector<RunEnergy> runs{{.measured_J = 100, .predicted_J = 110},
                              {.measured_J = 300, .predicted_J = 270}};
  EXPECT_EQ(runs[0].gap_J(), 10);
  EXPECT_EQ(absolute_gap_J(runs), 40);
  EXPECT_NEAR(energy_gap_percent(runs), 10, 1e-12);
}

TEST(Gap, OfTheTrueModelIsSmallInEveryChannel) {
  const std::vector<RunSignals> signals = three_runs();
  const GapReport report = gap_between(signals, nomad(), worn());
  ASSERT_TRUE(report.current_A.present && report.voltage_V.present);
  EXPECT_FALSE(report.battery_W.present || report.position_m.present) << "no such channel in the logs";
  EXPECT_LT(report.current_A.after_rms, 0.05 * report.current_A.before_rms);
  // 20 % of the friction torque is missing on both sides.
  const double missing_A = 0.2 * 0.36 / nomad().motor.left.torque_per_ampere_Nm_A();
  EXPECT_NEAR(report.current_A.before_rms, missing_A, 0.1 * missing_A);
  double before_J = 0;
  for (const auto& [phase, gaps] : report.energy_by_phase_J) {
    EXPECT_GE(gaps.first, gaps.second) << phase;
    before_J += gaps.first;
  }
  EXPECT_GE(before_J, report.energy.before_J * (1 - 1e-9)) << "phases add up to the runs' gaps at least";
  EXPECT_LT(before_J, report.energy.before_J * 1.05);
}

/// Standby power is drawn from the battery and not by the motors: the gap of one says nothing of the other's.
TEST(Gap, OfTheBatteryIsStatedBesideThatOfTheMotors) {
  std::vector<RunSignals> signals = three_runs();
  EXPECT_FALSE(gap_between(signals, nomad(), worn()).battery_energy.has_value());
  Robot thirsty = worn();
  thirsty.power.standby_W += 8.9;
  double standby_J = 0, battery_J = 0;
  for (RunSignals& run : signals) {
    run.battery_power_W = predict(run, {.robot = thirsty}).battery_power_W;
    standby_J += 8.9 * run.period_s * static_cast<double>(run.size());
    battery_J += run.battery_power_W.sum() * run.period_s;
  }
  const GapReport report = gap_between(signals, worn(), thirsty);
  EXPECT_LT(report.energy.before_percent, 0.1);
  ASSERT_TRUE(report.battery_energy.has_value());
  EXPECT_NEAR(report.battery_energy->before_percent, 100 * standby_J / battery_J, 1e-9);
  EXPECT_NEAR(report.battery_energy->bias_before_percent, -100 * standby_J / battery_J, 1e-9);
  EXPECT_LT(report.battery_energy->after_percent, 1e-9);
  EXPECT_NEAR(report.battery_energy->shrink_fraction, 1.0, 1e-9);
  signals[1].battery_power_W = {};
  EXPECT_NEAR(gap_between(signals, worn(), thirsty).battery_energy->shrink_fraction, 1.0, 1e-9)
      << "a run without it takes no part";
  for (RunSignals& run : signals) run.motor_power_W = {};
  EXPECT_FALSE(gap_between(signals, worn(), thirsty).battery_energy.has_value())
      << "without motors the headline is the battery's";
}

/// Runs that are all alike leave nothing to chance but another day.
TEST(Gap, OfEqualRunsShrinksByAnIntervalAroundTheShrink) {
  const std::vector<RunSignals> signals(3, three_runs()[1]);
  Robot half = nomad();
  for (Side side : kSides) half.motor[side].friction_torque_Nm *= 1.1;
  const EnergyGap gap = gap_between(signals, nomad(), half).energy;
  EXPECT_NEAR(gap.shrink_fraction, 0.5, 0.05);
  EXPECT_NEAR(gap.shrink_interval_95.first, gap.shrink_fraction, 0.1);
  EXPECT_NEAR(gap.shrink_interval_95.second, gap.shrink_fraction, 0.1);
}

/// A wattmeter that reads 5 W less than the model predicts, in every phase.
TEST(Gap, OfTheBatteryAloneIsSharedByThePhases) {
  std::vector<RunSignals> signals = three_runs();
  double duration_s = 0;
  for (RunSignals& run : signals) {
    run.battery_power_W = predict(run, {.robot = nomad()}).battery_power_W.array() - 5.0;
    run.motor_current_A = run.motor_voltage_V = run.motor_power_W = {};
    duration_s += run.period_s * static_cast<double>(run.size());
  }
  double before_J = 0;
  for (const auto& [phase, gaps] : gap_between(signals, nomad(), nomad()).energy_by_phase_J)
    before_J += gaps.first;
  EXPECT_NEAR(before_J, 5.0 * duration_s, 1e-6 * duration_s);
}

/// Speed along the heading, speed of the wheels across it and acceleration tell the phase.
TEST(Phase, FollowsTheMotion) {
  const Robot robot = nomad();
  const auto phase = [&](double left, double right, double rate_left, double rate_right) {
    RunSignals run;
    const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
    run.wheel_speed_rad_s = {one(left), one(right)};
    run.wheel_acceleration_rad_s2 = {one(rate_left), one(rate_right)};
    return std::string(phase_of(run, robot.geometry, 0));
  };
  EXPECT_EQ(phase(0, 0, 0, 0), "standstill");
  EXPECT_EQ(phase(-5, 5, 0, 0), "spin");
  EXPECT_EQ(phase(5, -5, 3, 3), "spin");
  EXPECT_EQ(phase(4, 6, 0, 0), "turn");
  EXPECT_EQ(phase(6, 4, 0, 0), "turn");
  EXPECT_EQ(phase(5, 5, 0, 0), "cruise");
  EXPECT_EQ(phase(5, 5, 5, 5), "accelerate");
  EXPECT_EQ(phase(5, 5, -5, -5), "brake");
  EXPECT_EQ(phase(-5, -5, -5, -5), "accelerate");
  EXPECT_EQ(phase(-5, -5, 5, 5), "brake");
}

}  // namespace
}  // namespace joulepath
