#include "extensions/onboard/monitor/energy_meter.hpp"

#include <cmath>

#include "model/power.hpp"

namespace joulepath {
namespace {

constexpr double kBridged_s = 1.0;  ///< longer steps count as without a reading

}  // namespace

double EnergyMeter::power_W(const MonitorRow& row) const {
  const double battery_W = row.battery_voltage_V * row.battery_current_A;
  if (!std::isnan(battery_W)) return battery_W;
  Sided<double> motor_W = row.motor_power_W;
  for (const Side side : kSides)
    if (std::isnan(motor_W[side])) motor_W[side] = row.motor_voltage_V[side] * row.motor_current_A[side];
  if (std::isnan(motor_W.left + motor_W.right)) return kAbsent;
  return supply_power_W(supply_, motor_W) + supply_.standby_W;
}

void EnergyMeter::add(const MonitorRow& row) {
  const double now_W = power_W(row);
  if (std::isnan(now_W)) return;
  const double step_s = row.time_s - last_s_;
  if (step_s > 0) {
    energy_J_ += 0.5 * (last_W_ + now_W) * step_s;
    if (step_s > kBridged_s) bridged_s_ += step_s;
  }
  last_s_ = row.time_s;
  last_W_ = now_W;
}

}  // namespace joulepath
