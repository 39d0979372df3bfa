#pragma once

#include <functional>
#include <string_view>

#include "planner/motion/path_motion.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// Calls `use(limit, ratio)` for every finite limit with |value|/limit at a state, straight from the model
/// at the exact place (no coefficient of the optimizer). Names are keys of Limits without their unit,
/// motor_voltage and motor_current. A limit of zero that is used gives an infinite ratio.
void for_each_limit_use(const PathMotion& motion, const Limits& limits, const std::vector<SpeedCap>& caps,
                        const ProfileState& state, double jerk,
                        const std::function<void(std::string_view, double)>& use);

/// Whether the acceleration of a profile jumps anywhere, its start and end included: no finite jerk limit
/// allows that. `s` is set to the first place.
[[nodiscard]] bool acceleration_jumps(const Profile& profile, double& s);

}  // namespace joulepath
