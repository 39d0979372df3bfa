#include "planner/path/geometry/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/assert.hpp"
// Design: docs/decisions/0200-paths.md
namespace joulepath {

bool is_turn(const PathPiece& piece) { return std::holds_alternative<TurnInPlace>(piece); }

double piece_length(const PathPiece& piece) {
  if (const auto* turn = std::get_if<TurnInPlace>(&piece)) return std::abs(turn->angle_rad);
  return std::get<Curve>(piece).length_m();
}

PathPoint piece_point(const PathPiece& piece, double s) {
  if (const auto* curve = std::get_if<Curve>(&piece)) return curve->at(s);
  const TurnInPlace& turn = std::get<TurnInPlace>(piece);
  Pose pose = turn.start;
  pose.heading_rad += std::copysign(std::clamp(s, 0.0, std::abs(turn.angle_rad)), turn.angle_rad);
  return {pose, 0, 0};
}

PathBend piece_bend(const PathPiece& piece, double s) {
  const auto* curve = std::get_if<Curve>(&piece);
  return curve ? curve->bend(s) : PathBend{};
}

std::vector<double> piece_breakpoints(const PathPiece& piece) {
  if (const auto* curve = std::get_if<Curve>(&piece)) return curve->breakpoints_m();
  return {0, piece_length(piece)};
}

int travel_sign(const PathPiece& piece) {
  if (is_turn(piece)) return 0;
  return std::get<Curve>(piece).direction() == Direction::forward ? 1 : -1;
}

int turn_sign(const PathPiece& piece) {
  if (!is_turn(piece)) return 0;
  return std::get<TurnInPlace>(piece).angle_rad < 0 ? -1 : 1;
}

double Path::distance_m() const {
  double sum_m = 0;
  for (const PathPiece& piece : pieces)
    if (!is_turn(piece)) sum_m += piece_length(piece);
  return sum_m;
}

double Path::turned_rad() const {
  double sum_rad = 0;
  for (const PathPiece& piece : pieces)
    if (is_turn(piece)) sum_rad += piece_length(piece);
  return sum_rad;
}

Pose Path::start() const {
  JOULEPATH_ASSERT(!pieces.empty(), "an empty path has no start");
  return piece_point(pieces.front(), 0).pose;
}

Pose Path::end() const {
  JOULEPATH_ASSERT(!pieces.empty(), "an empty path has no end");
  return piece_point(pieces.back(), piece_length(pieces.back())).pose;
}

double wrapped_angle_rad(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2 * std::numbers::pi : wrapped;
}

PathPiece straight_piece(const Pose& start, double length_m, Direction direction) {
  Pose along = start;
  if (direction == Direction::reverse) along.heading_rad -= std::numbers::pi;
  return Curve({LinearCurvature(along, length_m)}, direction);
}

void append_turn_to(Path& path, const Pose& from, double heading_rad) {
  const Pose start = path.pieces.empty() ? from : path.end();
  const double angle_rad = wrapped_angle_rad(heading_rad - start.heading_rad);
  if (std::abs(angle_rad) > 1e-9) path.pieces.push_back(TurnInPlace{start, angle_rad});
}

}  // namespace joulepath
