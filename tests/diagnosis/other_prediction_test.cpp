#include "diagnosis/where/other_prediction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/dataset_file.hpp"
#include "tests/support/practice_sets.hpp"

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

/// 10 J too much of 100 J in one run and 60 J too little of 300 J in the other.
TEST(OtherPrediction, TellsGapAndBiasOfAllItsRuns) {
  const auto constant_W = [](double both_W) {
    const Eigen::VectorXd one = Eigen::VectorXd::Constant(20, both_W / 2);
    return Sided<Eigen::VectorXd>{one, one};
  };
  std::vector<RunSignals> signals(2);
  for (RunSignals& run : signals) run.period_s = 0.5, run.time_s = Eigen::VectorXd::LinSpaced(20, 0, 9.5);
  signals[0].motor_power_W = constant_W(10);
  signals[1].motor_power_W = constant_W(30);
  const std::string told =
      told_by_others(signals, {{.power_W = constant_W(11)}, {.power_W = constant_W(24)}});
  EXPECT_NE(told.find("2 of 2 runs"), std::string::npos) << told;
  EXPECT_NE(told.find("energy gap 17.5 %, bias -12.5 %"), std::string::npos) << told;
}

}  // namespace
}  // namespace joulepath
