#pragma once

#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {

/// solve_profile() for a curve with a finite jerk limit. The fast solver finds the grid. If Ipopt is
/// requested, it solves again on that grid; Ipopt also takes over if the fast solver stalls (see
/// `handed_over`).
///
/// The lower bound is that of the problem without the jerk limit: a proof, tight only if the jerk limit
/// hardly binds. The profile itself is a local optimum.
[[nodiscard]] ProfileResult solve_with_jerk_limit(const ProfileRequest& request);

}  // namespace joulepath
