#include "extensions/onboard/drift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace joulepath {
namespace {

constexpr double kReference[] = {0.37, 0.35, 2.7}, kDeviation[] = {0.001, 0.0012, 0.01};
constexpr const char* kNames[] = {"friction_torque_left_Nm", "friction_torque_right_Nm", "resistance_ohm"};
constexpr double kRuns = 12;

/// A day's calibration of runs: estimates scatter, and so do their estimated deviations.
std::vector<CalibratedParameter> day(std::mt19937_64& random, double left_change = 0) {
  std::vector<CalibratedParameter> parameters;
  for (int i = 0; i < 3; ++i) {
    const double chi2 = std::chi_squared_distribution<double>(kRuns - 1)(random);
    const double truth = kReference[i] * (i == 0 ? 1 + left_change : 1.0);
    parameters.push_back({.name = kNames[i],
                          .nominal = kReference[i],
                          .value = std::normal_distribution<double>(truth, kDeviation[i])(random),
                          .standard_deviation = kDeviation[i] * std::sqrt(chi2 / (kRuns - 1)),
                          .effective_runs = kRuns,
                          .visibility = Visibility::seen});
  }
  return parameters;
}

TEST(Drift, StaysSilentAsOftenAsItSays) {
  std::mt19937_64 random(7);
  constexpr int kNights = 600;
  int alarms = 0;
  for (int night = 0; night < kNights; ++night) {
    std::vector<std::vector<CalibratedParameter>> days;
    for (int d = 0; d <= 5; ++d) days.push_back(day(random));
    alarms += find_drift(days, {.false_alarm_rate = 0.1, .draws = 1000}).drifted();
  }
  const double expected = 0.1 * kNights;
  EXPECT_NEAR(alarms, expected, 4 * std::sqrt(expected) + 0.2 * expected);
}

TEST(Drift, NamesWhatGrowsSlowlyAndNothingElse) {
  std::mt19937_64 random(11);
  std::vector<std::vector<CalibratedParameter>> days;
  int found_on = 0;
  for (int d = 0; d <= 30 && found_on == 0; ++d) {
    days.push_back(day(random, 0.1 * d / 30));
    if (d == 0) continue;
    const DriftResult result = find_drift(days, {.draws = 4000});
    for (const ParameterDrift& p : result.parameters)
      EXPECT_TRUE(!p.drifted || p.name == kNames[0]) << p.name;
    if (result.drifted()) found_on = d;
  }
  EXPECT_GT(found_on, 1);
  EXPECT_LT(found_on, 10);  // 3.3 %, with days that are known to 0.3 %
}

TEST(Drift, FindsAStepOfItsDetectableSizeFourTimesInFive) {
  std::mt19937_64 random(13);
  int found = 0;
  constexpr int kNights = 150;
  for (int night = 0; night < kNights; ++night) {
    std::vector<std::vector<CalibratedParameter>> days{day(random)};
    for (int d = 1; d <= 4; ++d) days.push_back(day(random));
    const double detectable = find_drift(days, {.draws = 1000}).parameters[0].detectable / kReference[0];
    days = {day(random)};
    for (int d = 1; d <= 4; ++d) days.push_back(day(random, detectable));
    found += find_drift(days, {.draws = 1000}).parameters[0].drifted;
  }
  EXPECT_NEAR(found / static_cast<double>(kNights), 0.8, 0.12);
}

TEST(Drift, AConstantThatADayDoesNotSeeIsNotCompared) {
  std::mt19937_64 random(17);
  std::vector<std::vector<CalibratedParameter>> days{day(random), day(random), day(random)};
  days.back()[2].visibility = Visibility::unseen;
  days[1][1].visibility = Visibility::unseen;
  const DriftResult result = find_drift(days);
  ASSERT_EQ(result.not_compared.size(), 1u);
  EXPECT_EQ(result.not_compared[0].name, kNames[2]);
  EXPECT_EQ(result.not_compared[0].days, std::vector<std::size_t>{2});
  ASSERT_EQ(result.parameters.size(), 2u);
  EXPECT_EQ(result.parameters[1].days, 1u);
}

TEST(Drift, CannotTellWhereNoConstantIsDetermined) {
  std::mt19937_64 random(19);
  std::vector<std::vector<CalibratedParameter>> days{day(random), day(random)};
  for (CalibratedParameter& parameter : days.back()) {
    parameter.visibility = Visibility::unseen;
    parameter.note = "no run has motor voltages";
  }
  days.front()[0].standard_deviation = std::nan("");
  const DriftResult result = find_drift(days);
  EXPECT_FALSE(result.can_tell());
  EXPECT_FALSE(result.drifted());
  ASSERT_EQ(result.not_compared.size(), 3u);
  EXPECT_EQ(result.not_compared[1].why, "no run has motor voltages");
  EXPECT_NE(result.not_compared[2].needs.find("voltages"), std::string::npos);
}

}  // namespace
}  // namespace joulepath
