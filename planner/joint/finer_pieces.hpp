#pragma once

#include <vector>

#include "planner/joint/joint_problem.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// Nearly the same path with more pieces: its end poses move by a centimetre at most, since a part of a piece
/// is not exactly a piece (cos phi and sin phi are linear on one).
struct FinerPieces {
  Start start{};                     ///< without a number of segments
  std::vector<std::size_t> parts{};  ///< of each piece before
};

/// Cuts the pieces that bend into parts of one length, up to about `most_pieces` in all; straight ones and
/// turns in place stay whole. `parameters`: of `program`.
[[nodiscard]] FinerPieces cut(const Program& program, const Eigen::VectorXd& parameters,
                              std::size_t most_pieces);

/// Squares of the rate on the grid of the finer pieces, linear between those of the program before.
[[nodiscard]] Eigen::VectorXd on_grid(const Program& before, const Eigen::VectorXd& squares,
                                      const FinerPieces& after);

}  // namespace joulepath::joint
