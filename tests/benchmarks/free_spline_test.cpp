#include "benchmarks/ways/free_spline.hpp"

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

/// B' nearly vanishes at t = 1/3 without turning back: 0.1 mm of bending at one place, with any curvature
/// there.
TEST(FreeSpline, AStandstillOfTheParameterIsNoPath) {
  for (const double heading_rad : {1e-6, 1e-4, 1e-2}) {
    const FreeSpline spline{.points_m = {{0, 0}, {1, 0}},
                            .start_heading_rad = heading_rad,
                            .start_handle_m = 1.0 / 3,
                            .goal_heading_rad = 2 * heading_rad,
                            .goal_handle_m = 4.0 / 3};
    EXPECT_FALSE(free_spline_path(spline)) << heading_rad;
  }
}

/// What is accepted bends less than the bound everywhere, as seen at 20,000 places; what is refused does not
/// by far, or nearly stands still.
TEST(FreeSpline, RandomSplinesKeepTheBoundOfCurvature) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place_m(-1.5, 1.5), angle_rad(-3, 3), handle_m(0.01, 2.0);
  int accepted = 0, refused = 0, needlessly = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const FreeSpline spline{.points_m = {{0, 0}, {place_m(random), place_m(random)}},
                            .start_heading_rad = angle_rad(random),
                            .start_handle_m = handle_m(random),
                            .goal_heading_rad = angle_rad(random),
                            .goal_handle_m = handle_m(random)};
    double most_per_m = 0, least_m = 1e9;
    for (int k = 0; k <= 20000; ++k) {
      const BezierDerivatives d = bezier_derivatives(spline_spans(spline)[0], k / 20000.0);
      const double speed_m = std::hypot(d.first_m[0], d.first_m[1]);
      least_m = std::min(least_m, speed_m);
      most_per_m =
          std::max(most_per_m, std::abs(d.first_m[0] * d.second_m[1] - d.first_m[1] * d.second_m[0]) /
                                   std::pow(speed_m, 3));
    }
    const bool is_path = free_spline_path(spline).has_value();
    (is_path ? accepted : refused) += 1;
    if (is_path) {
      EXPECT_LE(most_per_m, kTightest_per_m * (1 + 1e-9)) << trial;
    } else {
      needlessly += most_per_m < 0.98 * kTightest_per_m && least_m > 0.11 * 3 * spline.start_handle_m &&
                    least_m > 0.11 * 3 * spline.goal_handle_m;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 50);
  EXPECT_EQ(needlessly, 0);
}

}  // namespace
}  // namespace joulepath
