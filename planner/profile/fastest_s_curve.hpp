#pragma once

#include "planner/values/profile.hpp"

namespace joulepath {

/// The fastest motion from rest to rest over a length with limits on rate, acceleration and jerk only: seven
/// segments of constant jerk, fewer if a limit is not reached. A profile along a path with limits at most as
/// large takes at least this time.
[[nodiscard]] Profile fastest_s_curve(double length, double rate, double acceleration, double jerk);

}  // namespace joulepath
