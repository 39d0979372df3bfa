#pragma once

#include <Eigen/Dense>
#include <array>
#include <type_traits>
#include <vector>

#include "planner/joint/bordered_system.hpp"
#include "planner/joint/joint_problem.hpp"
#include "planner/joint/joint_segment.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// The part [f0, f1] of a piece, between two nodes of the speed. Part k begins at node k.
struct SpeedPart {
  std::size_t piece{};
  double f0{}, f1{};
  Eigen::Index b0{-1}, b1{-1};               ///< unknown squares at its ends; -1: at rest
  std::array<Eigen::Index, 3> parameters{};  ///< the piece's knots and length, see Program
};

/// The parts of a program's pieces; the robot stands at both ends of the path and at the stops.
[[nodiscard]] inline std::vector<SpeedPart> speed_parts(const Program& program) {
  std::vector<SpeedPart> parts;
  Eigen::Index unknowns = 0;
  for (std::size_t j = 0; j < program.pieces.size(); ++j) {
    const Piece& piece = program.pieces[j];
    const auto share = [&](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(piece.segments);
    };
    for (std::size_t i = 0; i < piece.segments; ++i) {
      SpeedPart part{.piece = j,
                     .f0 = share(i),
                     .f1 = share(i + 1),
                     .parameters = {piece.from, piece.to, program.length_of(j)}};
      part.b0 = parts.empty() ? -1 : parts.back().b1;
      const bool ends = i + 1 == piece.segments, last = ends && j + 1 == program.pieces.size();
      part.b1 = last || (ends && piece.rests_after) ? -1 : unknowns++;
      parts.push_back(part);
    }
  }
  return parts;
}

/// The variables of part `k`: numbers, or jets, for which a square at rest is no variable.
template <class Real>
std::array<Real, kSegmentVariables> variables_of(const SpeedPart& part, std::size_t k,
                                                 const Eigen::VectorXd& squares,
                                                 const Eigen::VectorXd& parameters) {
  const auto at = static_cast<Eigen::Index>(k);
  const auto [from, to, length] = part.parameters;
  const std::array<double, kSegmentVariables> x{squares[at], squares[at + 1], parameters[from],
                                                parameters[to], parameters[length]};
  std::array<Real, kSegmentVariables> variables;
  for (std::size_t i = 0; i < x.size(); ++i)
    if constexpr (std::is_same_v<Real, double>)
      variables[i] = x[i];
    else
      variables[i] =
          (i == 0 && part.b0 < 0) || (i == 1 && part.b1 < 0) ? Real(x[i]) : Real::variable(i, x[i]);
  return variables;
}

/// Changes of a part's variables by a step of all unknowns.
[[nodiscard]] inline std::array<double, kSegmentVariables> changes_of(const SpeedPart& part,
                                                                      const UnknownVector& step) {
  const auto [from, to, length] = part.parameters;
  return {part.b0 < 0 ? 0 : step.squares[part.b0], part.b1 < 0 ? 0 : step.squares[part.b1],
          step.parameters[from], step.parameters[to], step.parameters[length]};
}

}  // namespace joulepath::joint
