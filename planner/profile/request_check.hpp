#pragma once

#include <optional>

#include "planner/values/infeasibility.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// A path or a number of the request that makes no sense by itself: NaN, negative, nothing to drive.
[[nodiscard]] std::optional<Infeasibility> senseless(const ProfileRequest& request);

}  // namespace joulepath
