#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// Greatest power (W) that a battery supplies at its terminals: U^2/(4 R), at half of the open-circuit
/// voltage. Infinite without a voltage or a resistance.
[[nodiscard]] double most_battery_power_W(const Battery& battery);

/// The same as a limit of plans, with room for their rounding.
[[nodiscard]] double planned_battery_power_W(const Battery& battery);

}  // namespace joulepath
