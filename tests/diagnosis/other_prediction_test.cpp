#include "diagnosis/where/other_prediction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "scenarios/result_files/next_step.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/practice_sets.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// A simulator that is right except for its currents, a third too high, while the robot reverses.
Trajectory wrong_in_reverse(const Trajectory& log) {
  Trajectory other;
  other.time_s = log.time_s;
  other.motor_voltage_V = log.motor_voltage_V;
  other.motor_current_A = log.motor_current_A;
  for (std::size_t i = 0; i < log.size(); ++i)
    if (log.wheel_speed_rad_s.left[i] < -0.3 && log.wheel_speed_rad_s.right[i] < -0.3)
      for (Side side : kSides) other.motor_current_A[side][i] *= 4.0 / 3;
  return other;
}

TEST(OtherPrediction, LocationRefersToTheOtherSimulatorAndCausesToOurs) {
  Dataset dataset = read_dataset(testing::practice_file("p03_rolling_resistance"));
  for (auto& run : dataset.runs) run.predicted = wrong_in_reverse(run.log);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 50});
  const auto reverse = std::ranges::find_if(
      d.where, [](const WhereCell& cell) { return cell.axis == "direction" && cell.value == "reverse"; });
  ASSERT_NE(reverse, d.where.end());
  EXPECT_GT(reverse->share_of_gap, 0.95);
  ASSERT_EQ(d.causes.size(), 1u);
  EXPECT_EQ(d.causes.front().effect.name, "rolling_resistance");
  EXPECT_TRUE(std::ranges::any_of(d.notes, [](const std::string& note) {
    return note.find("another simulator's prediction") != std::string::npos;
  }));
}

Sided<Eigen::VectorXd> constant_W(double both_W) {
  const Eigen::VectorXd one = Eigen::VectorXd::Constant(20, both_W / 2);
  return {one, one};
}

/// Runs of 10 s with these powers (W) of both motors together.
std::vector<RunSignals> runs_with_power(const std::vector<double>& powers_W) {
  std::vector<RunSignals> signals(powers_W.size());
  for (std::size_t r = 0; r < signals.size(); ++r) {
    signals[r].period_s = 0.5, signals[r].time_s = Eigen::VectorXd::LinSpaced(20, 0, 9.5);
    signals[r].motor_power_W = constant_W(powers_W[r]);
  }
  return signals;
}

/// 10 J too much of 100 J in one run and 60 J too little of 300 J in the other; the third has no prediction.
TEST(SimulatorGap, IsThatOfTheRunsItPredicts) {
  const SimulatorGap gap = simulator_gap(runs_with_power({10, 30, 50}),
                                         {{.power_W = constant_W(11)}, {.power_W = constant_W(24)}, {}}, 0.5);
  EXPECT_EQ(gap.runs, 2u);
  EXPECT_EQ(gap.of_runs, 3u);
  EXPECT_NEAR(gap.gap_percent, 17.5, 1e-9);
  EXPECT_NEAR(gap.bias_percent, -12.5, 1e-9);
}

TEST(SimulatorGap, IsAtTheBatteryWhereNothingMeasuresTheMotors) {
  std::vector<RunSignals> signals = runs_with_power({0});
  signals[0].motor_power_W = {};
  signals[0].battery_power_W = Eigen::VectorXd::Constant(20, 20.0);
  const SimulatorGap gap =
      simulator_gap(signals, {{.battery_power_W = Eigen::VectorXd::Constant(20, 14.0)}}, 0.5);
  EXPECT_EQ(gap.runs, 1u);
  EXPECT_NEAR(gap.bias_percent, -30, 1e-9);
  EXPECT_EQ(simulator_gap(signals, {{.power_W = constant_W(11)}}, 0.5).runs, 0u) << "not of the same place";
}

/// Beyond noise and 1 % it is unexplained, below there is none of the simulator, whatever is wrong with the
/// file; runs too few for the file give no all-clear.
TEST(SimulatorGap, IsTheVerdictWhateverThatOfTheFileIs) {
  for (std::size_t k = 0; k < kVerdicts.size(); ++k)
    for (const double gap_percent : {0.2, 0.9, 1.1, 2.9, 3.1, 40.0})
      for (const double floor_percent : {0.1, 3.0}) {
        SimulatorGap gap{.runs = 5,
                         .gap_percent = gap_percent,
                         .noise_floor_percent = floor_percent,
                         .model_verdict = static_cast<Verdict>(k)};
        const bool beyond = gap_percent > 1 && gap_percent > floor_percent;
        EXPECT_EQ(gap.exceeds(), beyond);
        const Verdict silent =
            gap.model_verdict == Verdict::too_little_data ? Verdict::too_little_data : Verdict::no_gap;
        EXPECT_EQ(verdict_with(gap), beyond ? Verdict::unexplained : silent) << kVerdicts[k].name;
        gap.runs = 0;
        EXPECT_EQ(verdict_with(gap), gap.model_verdict) << "no prediction";
      }
}

/// Eight runs of a robot, its file, and a simulator whose currents are too high or too low by a factor.
Dataset with_simulator(const Robot& file, double factor) {
  Dataset dataset{.robot = file};
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const double kind = seed % 4;
    dataset.runs.push_back(testing::synthetic_run(testing::nomad(), "run_" + std::to_string(seed), 12, kind,
                                                  testing::swinging(0.3 + 0.1 * kind, 0.1, 1, 0.2 * kind),
                                                  {0.002, 0.005, 0.01}, seed));
    Trajectory& other = dataset.runs.back().predicted.emplace(dataset.runs.back().log);
    for (Side side : kSides)
      for (double& current_A : other.motor_current_A[side]) current_A *= factor;
  }
  return dataset;
}

struct FileOf {
  const char* what;
  Robot robot;
  Verdict verdict;
  std::vector<double> simulator_factors;
};

std::vector<FileOf> right_and_wrong_files() {
  Robot rough = testing::nomad(), other = testing::nomad();
  for (Side side : kSides) {
    rough.motor[side].friction_torque_Nm *= 0.6;
    other.motor[side].resistance_ohm *= 8;
  }
  return {{"right", testing::nomad(), Verdict::no_gap, {0.7}},
          {"less friction", rough, Verdict::explained, {1.002, 1.4}},
          {"another robot's", other, Verdict::unexplained, {1.002, 1.4}}};
}

TEST(SimulatorGap, IsTheVerdictWhateverIsWrongWithTheFile) {
  for (const FileOf& file : right_and_wrong_files())
    for (const double factor : file.simulator_factors) {
      const Diagnosis d = diagnose(with_simulator(file.robot, factor), {.bootstrap = 20});
      const bool sound = factor == 1.002;
      EXPECT_EQ(d.verdict, sound ? Verdict::no_gap : Verdict::unexplained) << file.what << ' ' << factor;
      EXPECT_EQ(file_verdict(d), file.verdict) << file.what << ' ' << verdict_name(file_verdict(d));
      EXPECT_NEAR(d.simulator.bias_percent, 100 * (factor - 1), 1.0) << file.what;
      const std::string said = diagnosis_sentence(d), step = next_step(d);
      const std::string begin = sound ? "No gap of the simulator: " : "Unexplained: ";
      EXPECT_EQ(said.rfind(begin + "the simulator's energy gap is ", 0), 0u) << said;
      EXPECT_EQ(step.rfind("The simulator needs no correction. Robot file: ", 0) == 0, sound) << step;
      EXPECT_NE(said.find(" Robot file: "), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace joulepath
