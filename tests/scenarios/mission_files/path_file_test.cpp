#include "scenarios/mission_files/path_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

/// A straight line as a planner on a grid writes it: steps along an axis and diagonal ones.
std::string grid_steps(double cell_m, double turned_rad) {
  std::string rows = "x_m,y_m\n";
  for (int i = 0; i <= 60; ++i) {
    const double x = i * cell_m, y = std::floor(0.4 * i) * cell_m;
    rows += std::to_string(x * std::cos(turned_rad) - y * std::sin(turned_rad)) + "," +
            std::to_string(x * std::sin(turned_rad) + y * std::cos(turned_rad)) + "\n";
  }
  return rows;
}

double most_bend_per_m(const Path& path) {
  double most = 0;
  for (const PathPiece& piece : path.pieces)
    for (int i = 0; i <= 1000; ++i)
      most = std::max(most, std::abs(piece_bend(piece, piece_length(piece) * i / 1000).curvature_per_m));
  return most;
}

TEST(PathFile, StepsOfAGridDoNotBendThePath) {
  const ScratchDirectory scratch;
  for (const double cell_m : {0.05, 0.03})
    for (const double turned_rad : {0.0, 0.5}) {
      std::vector<std::string> notes;
      const Path path =
          read_waypoints(scratch.write("grid.csv", grid_steps(cell_m, turned_rad)), {}, {}, &notes);
      EXPECT_LT(most_bend_per_m(path), 1 / (2 * cell_m)) << cell_m << " " << turned_rad;
      ASSERT_EQ(notes.size(), 1u);
      EXPECT_NE(notes.front().find("--tolerance"), std::string::npos);
    }
}

/// A corner that is meant is followed closely, and a note says that it sets the speed.
TEST(PathFile, ASharpCornerIsKeptAndNoted) {
  const ScratchDirectory scratch;
  std::string corner = "x_m,y_m\n";
  for (int i = 0; i <= 40; ++i)
    corner +=
        std::to_string(0.05 * std::min(i, 20)) + "," + std::to_string(0.05 * std::max(0, i - 20)) + "\n";
  std::vector<std::string> notes;
  const Path path = read_waypoints(scratch.write("corner.csv", corner), {}, {}, &notes);
  EXPECT_GT(most_bend_per_m(path), 1 / 0.05);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes.front().find("which sets the speed (--tolerance sets it)"), std::string::npos)
      << notes.front();
}

TEST(PathFile, AToleranceIsRefusedWhereNothingIsFitted) {
  const ScratchDirectory scratch;
  const std::string corners =
      scratch.write("corners.csv", "x_m,y_m,corner_radius_m\n0,0,0\n2,0,0.3\n2,2,0\n");
  EXPECT_NO_THROW((void)read_waypoints(corners));
  EXPECT_THROW((void)read_waypoints(corners, 0.02), ConfigError);
  const Document curves = Document::parse("bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]]]\n", "path.yaml");
  EXPECT_NO_THROW((void)path_from(curves));
  EXPECT_THROW((void)path_from(curves, {}, nullptr, 0.02), ConfigError);
}

TEST(PathFile, AStatedToleranceIsKeptAndAStraightLineNeedsNone) {
  const ScratchDirectory scratch;
  std::vector<std::string> notes;
  const std::string grid = scratch.write("grid.csv", grid_steps(0.05, 0));
  EXPECT_GT(most_bend_per_m(read_waypoints(grid, 0.01, {}, &notes)), 1 / 0.05);
  std::string arc = "x_m,y_m\n";
  for (int i = 0; i <= 60; ++i)
    arc += std::to_string(2 * std::sin(0.025 * i)) + "," + std::to_string(2 - 2 * std::cos(0.025 * i)) + "\n";
  EXPECT_NEAR(most_bend_per_m(read_waypoints(scratch.write("arc.csv", arc), {}, {}, &notes)), 0.5, 0.1);
  EXPECT_TRUE(notes.empty());
}

}  // namespace
}  // namespace joulepath
