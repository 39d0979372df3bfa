#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// solve_profile() for a curve with a finite jerk limit. The fast solver finds the grid; Ipopt settles the
/// profile on it where it is asked for, and takes over where the fast solver stalls (`handed_over` says so).
///
/// The lower bound is that of the problem without the jerk limit: a proof, and tight only where the limit
/// hardly binds. The profile itself is a local optimum.
[[nodiscard]] ProfileResult solve_with_jerk_limit(const ProfileRequest& request);

}  // namespace joulepath
