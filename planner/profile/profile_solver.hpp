#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Least-energy (or least-time) profile within every limit, also between nodes. Returns a verdict for an
/// impossible request and does not throw.
[[nodiscard]] ProfileResult solve_profile(const ProfileRequest& request);

}  // namespace joulepath
