#include "model/battery_charge.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/battery_power.hpp"
#include "model/battery_sag.hpp"
#include "model/power.hpp"

namespace joulepath {
namespace {

Battery with_curve() {
  return at_charge({.capacity_Wh = 100,
                    .internal_resistance_ohm = 0.4,
                    .open_circuit_curve = {{0.0, 20.0}, {0.1, 22.0}, {0.9, 25.0}, {1.0, 28.0}}},
                   1.0);
}

TEST(OpenCircuitCurve, IsLinearBetweenItsPointsAndConstantBeyond) {
  const Battery battery = with_curve();
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(battery, 0.05), 21.0);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(battery, 0.5), 23.5);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(battery, 0.9), 25.0);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(battery, -0.2), 20.0);
  EXPECT_DOUBLE_EQ(open_circuit_voltage_V(battery, 1.2), 28.0);
  EXPECT_DOUBLE_EQ(at_charge(battery, 0.5).open_circuit_voltage_V, 23.5);
}

/// dz/dt = -U i/(Q U) with Q = capacity over the mean voltage, by small steps.
TEST(OpenCircuitCurve, TheChargeFollowsTheCurrentThatIsDrawn) {
  const Battery battery = with_curve();
  const double mean_V = 0.1 * 21 + 0.8 * 23.5 + 0.1 * 26.5, charge_As = 100 * 3600 / mean_V;
  double fraction = 0.97;
  constexpr int kSteps = 200'000;
  const double step_J = 0.93 * 360'000 / kSteps;
  for (int k = 0; k < kSteps; ++k) fraction -= step_J / open_circuit_voltage_V(battery, fraction) / charge_As;
  EXPECT_NEAR(fraction_after(battery, 0.97, 0.93 * 360'000), fraction, 1e-5);
  EXPECT_GT(fraction, 0.0);
}

TEST(OpenCircuitCurve, EnergyBetweenIsTheInverseOfDrawing) {
  const Battery battery = with_curve();
  EXPECT_NEAR(energy_share_between(battery, 0, 1), 1.0, 1e-12);
  for (const double from : {1.0, 0.95, 0.4, 0.03})
    for (const double to : {1.0, 0.7, 0.1, 0.01, -0.1}) {
      const double drawn_J = -energy_share_between(battery, from, to) * 360'000;
      EXPECT_NEAR(fraction_after(battery, from, drawn_J), to, 1e-12) << from << " to " << to;
    }
}

TEST(OpenCircuitCurve, AConstantVoltageIsTheOldLaw) {
  const Battery battery{.capacity_Wh = 100, .open_circuit_voltage_V = 25};
  EXPECT_DOUBLE_EQ(fraction_after(battery, 0.8, 36'000), 0.7);
  EXPECT_EQ(energy_share_between(battery, 0.2, 0.8), 0.8 - 0.2);
  EXPECT_EQ(motor_supply_V(battery), kNoLimit);
  EXPECT_EQ(motor_supply_V(with_curve()), 28.0);
}

TEST(BatterySag, IsTheResistanceTimesTheCurrentOfTheLoad) {
  const Battery battery = with_curve();
  const BatterySag sag(battery);
  for (const double power_W : {-200.0, -3.0, 0.0, 1e-6, 40.0, 300.0}) {
    const BatteryLoad load = battery_load(battery, power_W);
    EXPECT_NEAR(sag(power_W), battery.internal_resistance_ohm * load.current_A, 1e-12);
    EXPECT_NEAR(load.terminal_voltage_V + sag(power_W), 28.0, 1e-12);
  }
}

TEST(BatterySag, GoesOnBeyondTheGreatestPower) {
  const Battery battery = with_curve();
  const BatterySag sag(battery);
  const double most_W = most_battery_power_W(battery);
  EXPECT_NEAR(sag(most_W), 14.0, 0.02);
  EXPECT_GT(sag(1.1 * most_W), sag(most_W) + 1);
  EXPECT_TRUE(std::isfinite(sag(1e6)));
  EXPECT_TRUE(BatterySag(Battery{}).none());
}

TEST(ChargeCurrent, IsReachedAtTheGreatestChargingPower) {
  Battery battery = with_curve();
  EXPECT_EQ(most_charge_power_W(battery), kNoLimit);
  battery.max_charge_current_A = 3.0;
  EXPECT_NEAR(battery_load(battery, -most_charge_power_W(battery)).current_A, -3.0, 1e-12);
  EXPECT_NEAR(accepted_power_W(battery, 0.5, 500), (23.5 + 0.4 * 3) * 3, 1e-12);
  EXPECT_NEAR(stored_power_W(battery, 0.5, 500), 23.5 * 3, 1e-12);
  EXPECT_EQ(accepted_power_W(battery, 0.5, 20), 20);
}

}  // namespace
}  // namespace joulepath
