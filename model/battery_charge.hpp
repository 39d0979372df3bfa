#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// Open-circuit voltage (V) at a state of charge: linear between the points of the curve, constant beyond
/// them. The constant voltage where the battery has no curve.
[[nodiscard]] double open_circuit_voltage_V(const Battery& battery, double fraction);

/// The battery as it is at a state of charge: `open_circuit_voltage_V` from its curve.
[[nodiscard]] Battery at_charge(Battery battery, double fraction);

/// Energy between two states of charge, as a share of the capacity; negative where the second one is lower.
/// The charge that a full battery holds is its capacity over the curve's mean voltage, so that
///   dE = capacity (U(z) / mean U) dz,   z the state of charge.
[[nodiscard]] double energy_share_between(const Battery& battery, double from_fraction, double to_fraction);

/// State of charge after an energy (J, the loss in the internal resistance included) was drawn. Below 0 and
/// above 1 the voltage is that of the curve's end.
[[nodiscard]] double fraction_after(const Battery& battery, double fraction, double drawn_J);

/// Open-circuit voltage (V) that limits the motors' voltage: infinite where the battery states no curve.
[[nodiscard]] double motor_supply_V(const Battery& battery);

/// Greatest power (W) that a battery takes at its terminals, (U + R i) i at its `max_charge_current_A`;
/// infinite without one, or without a voltage.
[[nodiscard]] double most_charge_power_W(const Battery& battery);

}  // namespace joulepath
