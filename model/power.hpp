#pragma once

#include <vector>

#include "model/operating_point.hpp"

namespace joulepath {

/// Power of which the negative part is recovered with an efficiency: max(P, eta P).
inline double counted_power_W(double power_W, double efficiency) {
  return power_W >= 0 ? power_W : efficiency * power_W;
}

/// Power that the drives take from the supply. Negative power is recovered with an efficiency, for each wheel
/// alone (PowerSharing::wheel) or for the sum (PowerSharing::bus).
inline double supply_power_W(const PowerSupply& supply, const Sided<double>& motor_power_W) {
  const auto kept = [&](double power_W) { return counted_power_W(power_W, supply.regeneration_efficiency); };
  return supply.sharing == PowerSharing::bus ? kept(motor_power_W.left + motor_power_W.right)
                                             : kept(motor_power_W.left) + kept(motor_power_W.right);
}

/// The watts at the battery's terminals by cause: `total_W()` is supply power plus standby. Integrated
/// over time they are the joules of `energy_by_cause_J`.
struct PowerByCause {
  double copper_W{};  ///< winding loss, R i^2
  double coulomb_friction_W{};
  double viscous_friction_W{};
  double kinetic_W{};        ///< into kinetic energy; negative while braking
  double not_recovered_W{};  ///< negative motor power that is not recovered
  double standby_W{};
  std::vector<double> effect_W{};  ///< in the order of Plant::effects

  double motor_W() const;  ///< V i of both wheels
  double total_W() const;
};

/// Splits the power of an operating point into its causes. Effects that only change a constant of the
/// robot show up in the cause that they change.
[[nodiscard]] PowerByCause power_by_cause(const Plant& plant, const BodyMotion<double>& motion,
                                          const Site& site);
/// The same for wheels whose operating point is known.
[[nodiscard]] PowerByCause power_by_cause(const Plant& plant, const BodyMotion<double>& motion,
                                          const Site& site, const Sided<WheelState<double>>& wheels);

/// State of the battery at a power taken from its terminals.
struct BatteryLoad {
  bool possible{true};  ///< false: the battery cannot supply this power; the rest is at the most that it can
  double current_A{};
  double terminal_voltage_V{};
  double loss_W{};  ///< in the internal resistance
};

/// Solves P = (U - R_i i) i for the smaller current. A battery without a voltage has no loss.
[[nodiscard]] BatteryLoad battery_load(const Battery& battery, double terminal_power_W);

}  // namespace joulepath
