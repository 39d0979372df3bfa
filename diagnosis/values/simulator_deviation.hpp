#pragma once

#include <vector>

#include "model/sided.hpp"

namespace joulepath {

/// What a simulator's prediction has beyond the model at its own motion, one series for each channel; empty
/// for a channel that the prediction lacks.
template <class Series>
struct DeviationOf {
  Sided<Series> current_A{}, voltage_V{}, power_W{};
  Series battery_power_W{}, battery_voltage_V{};
  Series yaw_rate_rad_s{}, heading_rad{}, x_m{}, y_m{};
  Sided<Series> turning{};  ///< 1 where the simulator's wheel turns, so that dry friction has a known sign

  /// The same with `change(series)` in place of each series.
  template <class Other, class Change>
  [[nodiscard]] DeviationOf<Other> changed(const Change& change) const {
    const auto both = [&](const Sided<Series>& of) {
      return Sided<Other>{change(of.left), change(of.right)};
    };
    return {both(current_A),
            both(voltage_V),
            both(power_W),
            change(battery_power_W),
            change(battery_voltage_V),
            change(yaw_rate_rad_s),
            change(heading_rad),
            change(x_m),
            change(y_m),
            both(turning)};
  }
};

/// The same over time: the times are those at which the robot is where the simulator's samples are.
struct SimulatorDeviation {
  std::vector<double> time_s{};
  DeviationOf<std::vector<double>> of{};
};

}  // namespace joulepath
