#pragma once

#include <optional>

#include "model/trajectory.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/infeasibility.hpp"

namespace joulepath {

/// The verdict on a path that the robot's footprint cannot follow on a floor with its clearance: the place
/// where it is missed by most, how deep, and where the path stops being free. Absent: the path is free.
[[nodiscard]] std::optional<Infeasibility> blocked_path(const Path& path, const RouteSpace& space);

/// The same for a prescribed motion.
[[nodiscard]] std::optional<Infeasibility> blocked_motion(const Trajectory& motion, const RouteSpace& space);

}  // namespace joulepath
