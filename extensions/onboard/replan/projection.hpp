#pragma once

#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// Where a pose is beside a piece of path.
struct PathOffset {
  double s{};
  double lateral_m{};          ///< to the left of the robot's planned heading
  double heading_error_rad{};  ///< pose less path; of a turn in place 0, since its heading is s
};

/// Follows a pose along a piece: the foot of the perpendicular near the last one, so that a path that crosses
/// itself is not left for its other branch. Refers to the piece; allocates nothing.
class PathProjection {
 public:
  explicit PathProjection(const PathPiece& piece) : piece_(piece), length_(piece_length(piece)) {}

  /// `travelled`: about how far the robot has moved along the piece since the last call.
  PathOffset look(const Pose& pose, double travelled);

 private:
  PathOffset look_at_turn(const Pose& pose);

  const PathPiece& piece_;
  double length_{};
  double s_{};
};

}  // namespace joulepath
