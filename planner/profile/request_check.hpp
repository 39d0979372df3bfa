#pragma once

#include <optional>

#include "planner/values/infeasibility.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// The verdict on an invalid path or number of the request: NaN, negative, nothing to drive.
[[nodiscard]] std::optional<Infeasibility> senseless(const ProfileRequest& request);

}  // namespace joulepath
