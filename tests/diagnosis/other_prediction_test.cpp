#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/dataset_file.hpp"
#include "tests/support/locations.hpp"

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
  const std::string file =
      std::string(JOULEPATH_SOURCE_DIR) + "/../shared/data/practice/p03_rolling_resistance/dataset.yaml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no practice sets beside the sources";
  Dataset dataset = read_dataset(file);
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

}  // namespace
}  // namespace joulepath
