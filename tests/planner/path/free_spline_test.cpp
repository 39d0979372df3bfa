#include "planner/path/shape/free_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace joulepath {
namespace {

FreeSpline random_spline(std::mt19937& random, std::size_t points) {
  std::uniform_real_distribution<> place(-0.4, 0.4), heading(-1.0, 1.0), handle(0.2, 0.6);
  FreeSpline spline{.start_heading_rad = heading(random),
                    .start_handle_m = handle(random),
                    .goal_heading_rad = heading(random),
                    .goal_handle_m = handle(random)};
  for (std::size_t i = 0; i < points; ++i)
    spline.points_m.push_back({1.5 * static_cast<double>(i) + place(random), place(random)});
  return spline;
}

TEST(FreeSpline, PassesThroughItsPointsAndLeavesAndArrivesInItsHeadings) {
  std::mt19937 random(3);
  for (std::size_t points = 2; points < 6; ++points) {
    const FreeSpline spline = random_spline(random, points);
    const std::optional<Path> path = free_spline_path(spline);
    ASSERT_TRUE(path);
    EXPECT_NEAR(wrapped_angle_rad(path->start().heading_rad - spline.start_heading_rad), 0, 1e-12);
    EXPECT_NEAR(wrapped_angle_rad(path->end().heading_rad - spline.goal_heading_rad), 0, 1e-12);
    const Curve& curve = std::get<Curve>(path->pieces.front());
    for (std::size_t i = 0; i < points; ++i) {
      const Pose pose = curve.at(curve.breakpoints_m()[i]).pose;
      EXPECT_NEAR(pose.x_m, spline.points_m[i][0], 1e-9);
      EXPECT_NEAR(pose.y_m, spline.points_m[i][1], 1e-9);
    }
  }
}

TEST(FreeSpline, SecondDerivativesAreContinuousPerChordAtItsKnots) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const FreeSpline spline = random_spline(random, 5);
    const std::vector<BezierPoints> spans = spline_spans(spline);
    for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
      const BezierDerivatives end = bezier_derivatives(spans[i], 1),
                              begin = bezier_derivatives(spans[i + 1], 0);
      const auto chord = [&](std::size_t k) {
        return std::hypot(spline.points_m[k + 1][0] - spline.points_m[k][0],
                          spline.points_m[k + 1][1] - spline.points_m[k][1]);
      };
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_NEAR(end.first_m[c] / chord(i), begin.first_m[c] / chord(i + 1), 1e-12);
        EXPECT_NEAR(end.second_m[c] / (chord(i) * chord(i)),
                    begin.second_m[c] / (chord(i + 1) * chord(i + 1)), 1e-11);
      }
    }
  }
}

TEST(FreeSpline, ACuspIsNoPath) {
  // Handles that cross in the middle of the chord: the tangent vanishes at t = 1/2.
  const FreeSpline cusp{.points_m = {{0, 0}, {1, 0}},
                        .start_heading_rad = std::numbers::pi / 4,
                        .start_handle_m = std::numbers::sqrt2,
                        .goal_heading_rad = -std::numbers::pi / 4,
                        .goal_handle_m = std::numbers::sqrt2};
  EXPECT_FALSE(free_spline_path(cusp));
  FreeSpline round = cusp;
  round.start_handle_m = round.goal_handle_m = 0.5;
  EXPECT_TRUE(free_spline_path(round));
}

}  // namespace
}  // namespace joulepath
