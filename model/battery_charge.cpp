#include "model/battery_charge.hpp"

#include <algorithm>
#include <cmath>

#include "model/watt_hours.hpp"

namespace joulepath {
namespace {

/// Integral of the open-circuit voltage (V) over the state of charge, from the curve's first point on.
double voltage_integral_V(const std::vector<OpenCircuitPoint>& curve, double fraction) {
  if (fraction <= curve.front().fraction)
    return (fraction - curve.front().fraction) * curve.front().voltage_V;
  double sum_V = 0;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const OpenCircuitPoint &low = curve[k], &high = curve[k + 1];
    const double width = std::min(fraction, high.fraction) - low.fraction;
    if (width <= 0) return sum_V;
    const double slope = (high.voltage_V - low.voltage_V) / (high.fraction - low.fraction);
    sum_V += width * (low.voltage_V + 0.5 * slope * width);
  }
  return sum_V + std::max(0.0, fraction - curve.back().fraction) * curve.back().voltage_V;
}

double mean_voltage_V(const std::vector<OpenCircuitPoint>& curve) {
  return voltage_integral_V(curve, 1.0) - voltage_integral_V(curve, 0.0);
}

/// The state of charge with an integral of the voltage (V): the inverse of voltage_integral_V().
double fraction_at(const std::vector<OpenCircuitPoint>& curve, double integral_V) {
  if (integral_V <= 0) return curve.front().fraction + integral_V / curve.front().voltage_V;
  for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
    const OpenCircuitPoint &low = curve[k], &high = curve[k + 1];
    const double width = high.fraction - low.fraction;
    const double part_V = 0.5 * width * (low.voltage_V + high.voltage_V);
    if (integral_V <= part_V) {
      const double slope = (high.voltage_V - low.voltage_V) / width;
      return low.fraction +
             2 * integral_V /
                 (low.voltage_V + std::sqrt(low.voltage_V * low.voltage_V + 2 * slope * integral_V));
    }
    integral_V -= part_V;
  }
  return curve.back().fraction + integral_V / curve.back().voltage_V;
}

}  // namespace

double open_circuit_voltage_V(const Battery& battery, double fraction) {
  const std::vector<OpenCircuitPoint>& curve = battery.open_circuit_curve;
  if (curve.empty()) return battery.open_circuit_voltage_V;
  const auto above = std::find_if(curve.begin(), curve.end(),
                                  [&](const OpenCircuitPoint& point) { return point.fraction >= fraction; });
  if (above == curve.begin()) return curve.front().voltage_V;
  if (above == curve.end()) return curve.back().voltage_V;
  const OpenCircuitPoint& low = *(above - 1);
  const double share = (fraction - low.fraction) / (above->fraction - low.fraction);
  return low.voltage_V + share * (above->voltage_V - low.voltage_V);
}

Battery at_charge(Battery battery, double fraction) {
  battery.open_circuit_voltage_V = open_circuit_voltage_V(battery, fraction);
  return battery;
}

double energy_share_between(const Battery& battery, double from_fraction, double to_fraction) {
  const std::vector<OpenCircuitPoint>& curve = battery.open_circuit_curve;
  if (curve.empty()) return to_fraction - from_fraction;
  return (voltage_integral_V(curve, to_fraction) - voltage_integral_V(curve, from_fraction)) /
         mean_voltage_V(curve);
}

double fraction_after(const Battery& battery, double fraction, double drawn_J) {
  const double capacity_J = battery.capacity_Wh * kJoulesPerWh;
  const std::vector<OpenCircuitPoint>& curve = battery.open_circuit_curve;
  if (curve.empty()) return fraction - drawn_J / capacity_J;
  return fraction_at(curve,
                     voltage_integral_V(curve, fraction) - drawn_J / capacity_J * mean_voltage_V(curve));
}

double motor_supply_V(const Battery& battery) {
  return battery.open_circuit_curve.empty() ? kNoLimit : battery.open_circuit_voltage_V;
}

double most_charge_power_W(const Battery& battery) {
  const double U = battery.open_circuit_voltage_V, R = battery.internal_resistance_ohm,
               i = battery.max_charge_current_A;
  return std::isfinite(U) && std::isfinite(i) ? (U + R * i) * i : kNoLimit;
}

}  // namespace joulepath
