// Pieces that are cut: the same path and speed, up to a centimetre.
#include "planner/joint/finer_pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "planner/joint/joint_starts.hpp"
#include "planner/joint/path_geometry.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::joint {
namespace {

constexpr std::size_t kMost = 30;  ///< pieces

/// A bend, a long line, a bend the other way, and a part in reverse after a rest.
Start with_bends() {
  const double pi = std::numbers::pi;
  Sketch sketch;
  sketch.parts = {{.from_rad = 0.1, .to_rad = 0.8, .length_m = 0.5},
                  {.from_rad = 0.8, .to_rad = 0.0, .length_m = 0.9},
                  {.from_rad = 0.0, .to_rad = 0.0, .length_m = 3.0},
                  {.from_rad = 0.0, .to_rad = -0.7, .length_m = 0.7, .rests_after = true},
                  {.from_rad = pi + 0.3, .to_rad = pi - 0.5, .length_m = 0.8, .sign = -1}};
  const double half_track_m = testing::nomad().geometry.half_track_m;
  Start start = assemble({sketch}, {{{1, 1}, {}}}, {}, half_track_m, 5);
  start.program.laws.assign(2, {.half_track_m = half_track_m});
  return start;
}

TEST(FinerPieces, ThePathStaysWhereItIs) {
  const Start whole = with_bends();
  const FinerPieces finer = cut(whole.program, whole.parameters, kMost);
  ASSERT_EQ(finer.parts.size(), whole.program.pieces.size());
  EXPECT_GT(finer.parts[0], 1u);
  EXPECT_EQ(finer.parts[2], 1u) << "a line stays whole";
  PathGeometry before(whole.program), after(finer.start.program);
  before.place(whole.parameters);
  after.place(finer.start.parameters);
  std::size_t next = 0;
  for (std::size_t j = 0; j < finer.parts.size(); ++j) {
    next += finer.parts[j];
    const Pose a = before.pose(j, 1), b = after.pose(next - 1, 1);
    EXPECT_LT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 1e-2) << j;
    EXPECT_NEAR(a.heading_rad, b.heading_rad, 1e-2) << j;
    EXPECT_EQ(whole.program.pieces[j].rests_after, finer.start.program.pieces[next - 1].rests_after) << j;
  }
  EXPECT_EQ(finer.start.program.targets.front().piece, finer.start.program.pieces.size() - 1);
}

/// A square that grows by one per node keeps its slope on the finer grid.
TEST(FinerPieces, SpeedsAreLinearBetweenThoseBefore) {
  const Start whole = with_bends();
  FinerPieces finer = cut(whole.program, whole.parameters, kMost);
  Eigen::Index nodes = 0, finer_nodes = 0;
  for (const Piece& piece : whole.program.pieces) nodes += static_cast<Eigen::Index>(piece.segments);
  for (Piece& piece : finer.start.program.pieces) {
    piece.segments = 3;
    finer_nodes += 3;
  }
  const Eigen::VectorXd squares =
      on_grid(whole.program, Eigen::VectorXd::LinSpaced(nodes + 1, 0, static_cast<double>(nodes)), finer);
  ASSERT_EQ(squares.size(), finer_nodes + 1);
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < finer.parts.size(); ++j)
    for (std::size_t i = 0; i < 3 * finer.parts[j]; ++i, ++at)
      EXPECT_NEAR(squares[at + 1] - squares[at], 5.0 / (3.0 * static_cast<double>(finer.parts[j])), 1e-12);
  EXPECT_NEAR(squares[finer_nodes], static_cast<double>(nodes), 1e-12);
}

}  // namespace
}  // namespace joulepath::joint
