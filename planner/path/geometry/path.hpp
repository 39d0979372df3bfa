#pragma once

#include <variant>
#include <vector>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

/// A turn on the spot about the axle midpoint; positive angles are counter-clockwise.
struct TurnInPlace {
  Pose start{};
  double angle_rad{};
};

/// A part of a path without a stop inside. Its path coordinate s is arc length in m for a curve and the angle
/// turned in rad, >= 0, for a turn in place.
using PathPiece = std::variant<Curve, TurnInPlace>;

[[nodiscard]] bool is_turn(const PathPiece& piece);
/// m for a curve, |angle| in rad for a turn in place.
[[nodiscard]] double piece_length(const PathPiece& piece);
/// Pose, curvature and its slope at s in [0, piece_length]. A turn in place has curvature 0 here: its
/// heading changes by turn_sign() per unit of s.
[[nodiscard]] PathPoint piece_point(const PathPiece& piece, double s);
/// Its curvature and slope alone.
[[nodiscard]] PathBend piece_bend(const PathPiece& piece, double s);
/// Ascending, both ends included; between them curvature and its slope are smooth.
[[nodiscard]] std::vector<double> piece_breakpoints(const PathPiece& piece);
/// Sign of the robot's linear speed: +1 forward, -1 reverse, 0 for a turn in place.
[[nodiscard]] int travel_sign(const PathPiece& piece);
/// +1 counter-clockwise, -1 clockwise for a turn in place, 0 for a curve.
[[nodiscard]] int turn_sign(const PathPiece& piece);

/// A way from a start pose to an end pose. Each piece begins with the pose at which the previous one ended
/// (headings equal modulo whole turns). The robot is at rest between pieces: a joint is a corner, a change of
/// direction or a step of curvature that cannot be driven at speed.
struct Path {
  std::vector<PathPiece> pieces{};

  [[nodiscard]] double distance_m() const;  ///< arc length of all curves
  [[nodiscard]] double turned_rad() const;  ///< sum of |angle| of the turns in place
  [[nodiscard]] Pose start() const;         ///< requires a piece
  [[nodiscard]] Pose end() const;           ///< requires a piece
};

/// Angle in (-pi, pi] that is equal modulo whole turns.
[[nodiscard]] double wrapped_angle_rad(double angle_rad);

/// A straight piece along the heading of `start`.
[[nodiscard]] PathPiece straight_piece(const Pose& start, double length_m,
                                       Direction direction = Direction::forward);

/// Appends a turn in place from the path's end (or from `from` if the path is empty) to a heading, the
/// shorter way round; nothing if the heading is already there to 1e-9 rad.
void append_turn_to(Path& path, const Pose& from, double heading_rad);

}  // namespace joulepath
