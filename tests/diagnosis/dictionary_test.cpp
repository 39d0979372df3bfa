// Entries of the dictionary against their formulas.
#include "diagnosis/prediction/dictionary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// A drive forward and one in reverse with turns, so that speeds and currents have both signs.
RunSignals there_or_back(double speed_m_s) {
  const Run run =
      testing::synthetic_run(testing::nomad(), "run", 10, 2.0, testing::swinging(speed_m_s, 0.2, 1.3, 0.6));
  return make_run_signals(run, 0, testing::nomad());
}

/// Rows of the entries of a family and channel, one column per entry.
std::vector<Eigen::VectorXd> entries_of(const RunSignals& run, const std::string& family,
                                        const std::string& of, Channel channel) {
  const Robot robot = testing::nomad();
  const DictionaryLayout layout = lay_out({run}, robot);
  const std::vector<DictionaryEntry> names = dictionary_entries(layout);
  const std::vector<Eigen::MatrixXd> rows =
      dictionary_rows(layout, run, robot, predict(run, {.robot = robot}));
  EXPECT_EQ(names.size(), rows.size());
  std::vector<Eigen::VectorXd> found;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (names[k].family == family && names[k].channel == of) found.push_back(rows[k].col(channel));
  return found;
}

class Supply : public ::testing::TestWithParam<double> {};

TEST_P(Supply, PowerDependsOnTheSizeOfCurrentsAndSpeeds) {
  const RunSignals run = there_or_back(GetParam());
  const Prediction p = predict(run, {.robot = testing::nomad()});
  const auto current = entries_of(run, "current", "battery power", kDriverPower);
  const auto speed = entries_of(run, "wheel speed", "battery power", kDriverPower);
  const auto power = entries_of(run, "motor power", "battery power", kDriverPower);
  ASSERT_TRUE(current.size() == 2 && speed.size() == 1 && power.size() == 2);
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const double left_A = p.current_A.left[j], right_A = p.current_A.right[j];
    EXPECT_NEAR(current[0][j], std::abs(left_A) + std::abs(right_A), 1e-12);
    EXPECT_NEAR(current[1][j], left_A * left_A + right_A * right_A, 1e-12);
    EXPECT_NEAR(speed[0][j],
                std::abs(run.wheel_speed_rad_s.left[j]) + std::abs(run.wheel_speed_rad_s.right[j]), 1e-12);
    const double sum_W = p.power_W.left[j] + p.power_W.right[j];
    EXPECT_NEAR(power[0][j] + power[1][j], sum_W, 1e-12);
    EXPECT_GE(power[0][j], 0.0);
    EXPECT_LE(power[1][j], 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Forward, Supply, ::testing::Values(0.5));
INSTANTIATE_TEST_SUITE_P(Reverse, Supply, ::testing::Values(-0.5));

}  // namespace
}  // namespace joulepath
