#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// Least-energy (or least-time) profile within every limit, between nodes too. Does not throw for an
/// impossible request: verdicts are data.
[[nodiscard]] ProfileResult solve_profile(const ProfileRequest& request);

}  // namespace joulepath
