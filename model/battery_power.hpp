#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// Greatest power (W) that a battery supplies at its terminals: U^2/(4 R), at half of the open-circuit
/// voltage. Infinite without a voltage or a resistance.
[[nodiscard]] double most_battery_power_W(const Battery& battery);

/// The same as a limit of plans, with room for their rounding.
[[nodiscard]] double planned_battery_power_W(const Battery& battery);

/// Power (W) that a battery at a state of charge takes at its terminals of what a charger offers, and the
/// part of it that is stored.
[[nodiscard]] double accepted_power_W(const Battery& battery, double fraction, double offered_W);
[[nodiscard]] double stored_power_W(const Battery& battery, double fraction, double offered_W);

}  // namespace joulepath
