#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "planner/joint/drive_law.hpp"
#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// Bounds of |phi|, or of |phi - pi|: of a search, and of the polishing of a path that lies on that bound.
/// Curvature 8.2 and WIDER over half the track.
inline constexpr double kMostDirection_rad = 1.45, kWiderDirection_rad = 1.52;

/// A piece of path between two knots of the direction phi (DirectionSegment), `segments` equal parts of its
/// length for the speed.
struct Piece {
  Eigen::Index from{}, to{};  ///< knots
  int sign{1};                ///< 1: phi about 0, forward; -1: phi about pi, in reverse
  std::size_t leg{};
  std::size_t law{};   ///< index into the laws
  bool rests_after{};  ///< the robot stands at its end: phi may jump
  std::size_t segments{};
  bool turns{};  ///< turns in place: phi is held at +-pi/2, between rests

  double straight_rad() const { return sign > 0 ? 0.0 : std::numbers::pi; }  ///< phi of a straight line
  /// Largest deviation of phi from a straight line, of the program's parameters.
  double bend_rad(const Eigen::VectorXd& parameters) const {
    return std::max(std::abs(parameters[from] - straight_rad()), std::abs(parameters[to] - straight_rad()));
  }
};

/// A pose that the path must reach at the end of a piece, in the frame of the start.
struct Target {
  std::size_t piece{};
  Point2 at_m{};
  std::optional<double> heading_rad{};  ///< whole turns included
};

/// A place, or a pose, that a start passes at the end of a piece, in the frame of the start.
struct Waypoint {
  std::size_t piece{};
  Point2 at_m{};
  std::optional<double> heading_rad{};  ///< whole turns included
};

/// Path and speed of legs as one program. The path begins at the origin with heading 0: `frame` is the start
/// on the floor.
struct Program {
  std::vector<Piece> pieces{};
  Eigen::Index knots{};
  std::vector<Target> targets{};
  std::vector<Waypoint> waypoints{};  ///< of the start alone
  std::vector<DriveLaw> laws{};
  Pose frame{};
  const FootprintChecker* checker{};              ///< null: an open floor
  double margin_m{};                              ///< beyond the checker's clearance
  double most_direction_rad{kMostDirection_rad};  ///< of |phi|, or of |phi - pi|

  Eigen::Index parameters() const { return knots + static_cast<Eigen::Index>(pieces.size()); }
  /// Index of a piece's length among the parameters: the knots' phi (rad), then the lengths tau (m).
  Eigen::Index length_of(std::size_t piece) const { return knots + static_cast<Eigen::Index>(piece); }
  double half_track_m() const { return laws.front().half_track_m; }
  double shortest_m(std::size_t piece) const;           ///< of a piece's length
  double least_length_m(Eigen::Index parameter) const;  ///< of a length's parameter, in any step
  std::vector<Eigen::Index> held() const;               ///< knots that do not move: those of turns in place
};

inline constexpr double kShortestPiece_m = 0.03, kShortestTurn_m = 1e-3;

inline double Program::shortest_m(std::size_t piece) const {
  return pieces[piece].turns ? kShortestTurn_m : kShortestPiece_m;
}

inline double Program::least_length_m(Eigen::Index parameter) const {
  return 0.3 * shortest_m(static_cast<std::size_t>(parameter - knots));
}

inline std::vector<Eigen::Index> Program::held() const {
  std::vector<Eigen::Index> all;
  for (const Piece& piece : pieces)
    if (piece.turns) all.insert(all.end(), {piece.from, piece.to});
  return all;
}

/// A program and parameters to begin with.
struct Start {
  Program program{};
  Eigen::VectorXd parameters{};
};

}  // namespace joulepath::joint
