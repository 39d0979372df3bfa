#pragma once

#include <cstddef>
#include <optional>

#include "model/trajectory.hpp"
#include "planner/path/floor/footprint_checker.hpp"

namespace joulepath {

/// A conflict of a way with obstacles: less than its clearance. Distances are arc lengths along the way.
struct PathConflict {
  double first_m{};     ///< start of the conflict
  double deepest_m{};   ///< place of the least clearance
  Collision deepest{};  ///< there
  std::size_t stretches{};
  double length_m{};  ///< of these stretches together
};

/// Checks a whole path, turns in place included. A point of the outline cannot enter an obstacle by more than
/// 2 mm undetected; the steps are 1 cm inside of one. Absent: the path is free.
[[nodiscard]] std::optional<PathConflict> path_conflict(const FootprintChecker& checker, const Path& path);

/// The same along a motion with a pose in every sample.
[[nodiscard]] std::optional<PathConflict> motion_conflict(const FootprintChecker& checker,
                                                          const Trajectory& motion);

}  // namespace joulepath
