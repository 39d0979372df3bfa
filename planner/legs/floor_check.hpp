#pragma once

#include <optional>

#include "model/trajectory.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/infeasibility.hpp"

namespace joulepath {

/// The verdict on a path that is not free for the robot's footprint with its clearance: the place of the
/// deepest conflict, its depth, and where the path stops being free. Absent: the path is free.
[[nodiscard]] std::optional<Infeasibility> blocked_path(const Path& path, const RouteSpace& space);

/// The same for a prescribed motion.
[[nodiscard]] std::optional<Infeasibility> blocked_motion(const Trajectory& motion, const RouteSpace& space);

}  // namespace joulepath
