#pragma once

#include <cstddef>
#include <optional>

#include "model/trajectory.hpp"
#include "planner/path/floor/footprint_checker.hpp"

namespace joulepath {

/// Where a way comes closer to obstacles than its clearance. Distances are arc lengths along the way.
struct PathConflict {
  double first_m{};     ///< where the way stops being free
  double deepest_m{};   ///< where the clearance is missed by most
  Collision deepest{};  ///< there
  std::size_t stretches{};
  double length_m{};  ///< of these stretches together
};

/// Looks along a whole path, turns in place included, in steps that no point of the outline can use to enter
/// an obstacle by more than 2 mm unseen; 1 cm where it is inside of one. Absent: the path is free.
[[nodiscard]] std::optional<PathConflict> path_conflict(const FootprintChecker& checker, const Path& path);

/// The same along a motion with a pose in every sample.
[[nodiscard]] std::optional<PathConflict> motion_conflict(const FootprintChecker& checker,
                                                          const Trajectory& motion);

}  // namespace joulepath
