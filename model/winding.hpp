#pragma once

#include <cmath>

#include "model/robot.hpp"

// Heat of a motor's winding. Design: docs/decisions/0101-limits-and-energy.md
namespace joulepath {

/// Change per kelvin of the resistance of copper, relative to that at a temperature (C) [IEC60034].
constexpr double copper_coefficient_1_K(double temperature_C) { return 1.0 / (235.0 + temperature_C); }

/// Resistance of a winding relative to the cold one, for a rise (K) of its temperature above ambient.
constexpr double copper_factor(const WindingThermal& winding, double rise_K) {
  return 1.0 + copper_coefficient_1_K(winding.ambient_C) * rise_K;
}

/// A value that follows a first-order law from `from` to `final_value`:
///   x(t) = from + (final - from) (1 - exp(-t/time_constant))
inline double first_order(double from, double final_value, double time_s, double time_constant_s) {
  return from + (final_value - from) * (1.0 - std::exp(-time_s / time_constant_s));
}

/// Rise (K) of a winding's temperature above the surroundings after a time (s) at a constant current (A):
///   C dx/dt = R (1 + alpha x) i^2 - x/R_th,
/// with R the cold winding's resistance. Exact: first-order, with a time constant that grows with the
/// current; above a certain current it is negative and the temperature runs away.
inline double rise_after_K(const WindingThermal& winding, double cold_resistance_ohm, double rise_K,
                           double current_A, double time_s) {
  const double loss_W = cold_resistance_ohm * current_A * current_A;
  const double rate_1_s =
      (1.0 / winding.resistance_K_W - copper_coefficient_1_K(winding.ambient_C) * loss_W) /
      winding.capacity_J_K;
  constexpr double kNoRate = 1e-12;  // of the time: the law is linear in it
  if (std::abs(rate_1_s * time_s) < kNoRate) return rise_K + loss_W / winding.capacity_J_K * time_s;
  return first_order(rise_K, loss_W / (winding.capacity_J_K * rate_1_s), time_s, 1.0 / rate_1_s);
}

}  // namespace joulepath
