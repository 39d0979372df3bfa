#pragma once

#include <optional>

#include "planner/values/infeasibility.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// The verdict on an invalid path or number of the request: NaN, negative, nothing to drive.
[[nodiscard]] std::optional<Infeasibility> senseless(const ProfileRequest& request);

/// Whether a request leaves the time open and a second costs nothing at a vanishing speed, at least at one of
/// some places of the path: neither standby nor a price, and no friction against which motors must hold a
/// current. Then slower is always cheaper, and no time is the cheapest.
[[nodiscard]] bool slower_is_always_cheaper(const ProfileRequest& request);

}  // namespace joulepath
