#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// solve_profile() for a curve with a finite jerk limit. Ipopt solves it whatever solver is asked for; with
/// `fast` the summary's `handed_over` says so.
///
/// The lower bound is that of the problem without the jerk limit: a proof, and tight only where the limit
/// hardly binds. The profile itself is a local optimum.
[[nodiscard]] ProfileResult solve_with_jerk_limit(const ProfileRequest& request);

}  // namespace joulepath
