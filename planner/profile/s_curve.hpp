#pragma once

#include "planner/values/profile.hpp"

namespace joulepath {

/// The fastest motion from rest to rest over a length whose rate, acceleration and jerk are limited, and by
/// nothing else: seven segments of constant jerk, fewer where a limit is not reached. No profile along a path
/// that never allows more takes less time.
[[nodiscard]] Profile fastest_s_curve(double length, double rate, double acceleration, double jerk);

}  // namespace joulepath
