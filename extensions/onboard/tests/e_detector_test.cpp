// The monitor's sequential test and its meter of energy, against their formulas.
#include "extensions/onboard/monitor/e_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "extensions/onboard/monitor/energy_meter.hpp"

namespace joulepath {
namespace {

constexpr double kTolerance = 0.2, kSigma = 0.5, kHours = 0.1;

/// Expected evidence after one estimate from N(mean, sigma^2), by the midpoint rule.
double expected_hours(double mean) {
  EDetector detector(kTolerance, {0.4}, 1e6);
  double sum = 0;
  constexpr int kParts = 4000;
  for (int k = 0; k < kParts; ++k) {
    const double z = -10 + 20 * (k + 0.5) / kParts;
    detector.restart(1.0);
    detector.add(1.0 + mean + kSigma * z, kSigma, kHours, 0);
    sum += 20.0 / kParts * std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI) * detector.evidence_hours();
  }
  return sum;
}

/// At the border of the tolerance one of the two alternatives keeps its expectation; inside both lose.
TEST(EDetector, GainsNothingInExpectationWithinTheTolerance) {
  for (const double mean : {0.0, kTolerance, -kTolerance})
    EXPECT_LE(expected_hours(mean), kHours * (1 + 1e-9)) << mean;
  EXPECT_GT(expected_hours(kTolerance), 0.5 * kHours);
  EXPECT_NEAR(expected_hours(kTolerance), expected_hours(-kTolerance), 1e-9);
  EXPECT_GT(expected_hours(kTolerance + 0.4), kHours);
}

TEST(EDetector, TellsWhenAChangeOfEitherSignBegan) {
  for (const double sign : {1.0, -1.0}) {
    EDetector detector(kTolerance, {0.4, 0.8}, 100);
    for (int k = 0; k < 50; ++k) EXPECT_FALSE(detector.add(0.1 * sign, kSigma, kHours, k));
    EXPECT_FALSE(detector.suspicious());
    int alarm = 0;
    for (int k = 50; k < 200 && alarm == 0; ++k)
      if (detector.add(sign, kSigma, kHours, k)) alarm = k;
    EXPECT_GT(alarm, 51);
    EXPECT_LT(alarm, 70);
    EXPECT_TRUE(detector.suspicious());
    EXPECT_EQ(detector.since_s(), 50);
    detector.restart(sign);
    EXPECT_EQ(detector.evidence_hours(), 0.0);
    for (int k = 0; k < 50; ++k)
      EXPECT_FALSE(detector.add(sign, kSigma, kHours, k)) << "the new mean is none";
  }
}

TEST(EDetector, IgnoresWhatIsNoEstimate) {
  EDetector detector(kTolerance, {0.4}, 1);
  for (const double sigma : {0.0, -1.0, double(NAN), double(INFINITY)})
    EXPECT_FALSE(detector.add(9, sigma, 5, 0));
  EXPECT_FALSE(detector.add(NAN, 1, 5, 0));
  EXPECT_EQ(detector.evidence_hours(), 0.0);
}

/// A ramp of the battery's power by the trapezoidal rule; its own reading goes before the motors'.
TEST(EnergyMeter, IntegratesTheBatterysPower) {
  EnergyMeter meter({.standby_W = 5});
  EXPECT_FALSE(meter.measures());
  for (int k = 0; k <= 20; ++k)
    meter.add({.time_s = 3 + 0.5 * k,
               .motor_power_W = {100, 100},
               .battery_voltage_V = 24,
               .battery_current_A = 0.1 * k});
  EXPECT_TRUE(meter.measures());
  EXPECT_NEAR(meter.energy_J(), 24 * 1.0 * 10, 1e-9);
  EXPECT_EQ(meter.bridged_s(), 0.0);
}

/// Motors' power, or voltage times current, with what the supply recovers, and standby.
TEST(EnergyMeter, AddsStandbyToTheMotors) {
  EnergyMeter meter({.standby_W = 5, .regeneration_efficiency = 0.5, .sharing = PowerSharing::wheel});
  for (int k = 0; k <= 10; ++k)
    meter.add({.time_s = 1.0 * k,
               .motor_voltage_V = {10, 10},
               .motor_current_A = {2, 2},
               .motor_power_W = {kAbsent, -8}});
  EXPECT_NEAR(meter.energy_J(), (20 - 4 + 5) * 10, 1e-9);
}

/// Rows without a reading are left out; the next one bridges them.
TEST(EnergyMeter, CountsTheTimeWithoutReadings) {
  EnergyMeter meter({});
  for (int k = 0; k <= 10; ++k)
    meter.add(
        {.time_s = 0.5 * k, .battery_voltage_V = 20, .battery_current_A = k > 3 && k < 8 ? kAbsent : 1.0});
  EXPECT_NEAR(meter.energy_J(), 20 * 5, 1e-9);
  EXPECT_NEAR(meter.bridged_s(), 2.5, 1e-12);
}

}  // namespace
}  // namespace joulepath
