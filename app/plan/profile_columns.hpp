#pragma once

#include <vector>

#include "app/report/columns.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// Time, place, speed, acceleration, and power and energy at the battery of profiles that are driven one
/// after the other, for plots: so many samples of each. A turn in place has speed 0; its rate is the yaw
/// rate.
[[nodiscard]] report::Columns profile_columns(const std::vector<const ProfileRequest*>& requests,
                                              const std::vector<Profile>& profiles, int samples = 150);

}  // namespace joulepath
