#pragma once

#include <limits>

#include "model/sided.hpp"

namespace joulepath {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// One row of a log as it arrives; NaN for what it does not have.
struct MonitorRow {
  double time_s{kAbsent};
  Sided<double> wheel_speed_rad_s{kAbsent, kAbsent};
  Sided<double> motor_voltage_V{kAbsent, kAbsent};
  Sided<double> motor_current_A{kAbsent, kAbsent};
  Sided<double> motor_power_W{kAbsent, kAbsent};
  double battery_voltage_V{kAbsent};
  double battery_current_A{kAbsent};
  double heading_rad{kAbsent};
  double payload_kg{kAbsent};  ///< as stated
};

}  // namespace joulepath
