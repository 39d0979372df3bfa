#pragma once

#include <functional>
#include <string_view>

#include "planner/motion/path_motion.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// Calls `use(name, |value| / limit)` for each finite limit of the table and each speed cap at a state. The
/// values come from the model at the exact place, not from the optimizer's coefficients.
void for_each_limit_use(const PathMotion& motion, const Limits& limits, const std::vector<SpeedCap>& caps,
                        const ProfileState& state, double jerk,
                        const std::function<void(std::string_view, double)>& use);

/// Whether the acceleration of a profile jumps anywhere, its start and end included: no finite jerk limit
/// allows that. `s` is the first such place.
[[nodiscard]] bool acceleration_jumps(const Profile& profile, double& s);

}  // namespace joulepath
