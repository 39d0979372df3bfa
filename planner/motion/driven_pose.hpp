#pragma once

#include <optional>

#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// The pose to which a piece's curvature leads from its start: x, y and heading integrated along the path
/// coordinate (Dormand-Prince, error 1e-9 a step) between the places where the curvature's slope may jump.
/// Nothing where no step resolves the curvature.
///
/// It differs from the piece's own end where the piece turns within less than the resolution of its path
/// coordinate: no profile over that coordinate slows down there.
[[nodiscard]] std::optional<Pose> driven_end(const PathPiece& piece);

/// Whether the pose to which the curvature leads is the end of the piece: to 1e-3 of its length and 1e-3 rad,
/// and what the joints of its segments may break.
[[nodiscard]] bool leads_to_its_end(const PathPiece& piece);

}  // namespace joulepath
