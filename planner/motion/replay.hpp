#pragma once

#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/replay_result.hpp"

namespace joulepath {

/// Integrates the profile's acceleration with an independent integrator (Dormand-Prince of order 5 in time,
/// on position, speed and energy, with the exact curvature) and checks every limit densely between nodes. The
/// drive must reach the path's end, at the pose to which the curvature leads (driven_pose.hpp).
[[nodiscard]] ReplayResult replay(const ProfileRequest& request, const Profile& profile);

}  // namespace joulepath
