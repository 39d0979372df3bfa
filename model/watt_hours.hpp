#pragma once

namespace joulepath {

inline constexpr double kSecondsPerHour = 3600.0;
/// One watt for one hour.
inline constexpr double kJoulesPerWh = kSecondsPerHour;

}  // namespace joulepath
