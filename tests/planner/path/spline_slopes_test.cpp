#include "planner/path/shape/spline_slopes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace joulepath {
namespace {

/// A spline with uneven chords.
FreeSpline bent_spline(std::mt19937& random, std::size_t points) {
  std::uniform_real_distribution<> step_m(0.3, 2.0), aside_m(-0.5, 0.5), heading_rad(-1.0, 1.0),
      handle_m(0.1, 0.8);
  FreeSpline spline{.start_heading_rad = heading_rad(random),
                    .start_handle_m = handle_m(random),
                    .goal_heading_rad = heading_rad(random),
                    .goal_handle_m = handle_m(random)};
  double x_m = 0;
  for (std::size_t i = 0; i < points; ++i, x_m += step_m(random))
    spline.points_m.push_back({x_m, aside_m(random)});
  return spline;
}

/// 0.7 x - 1.3 y + 0.4 heading at a place of a span.
double seen_at(const FreeSpline& spline, std::size_t span, double t) {
  const BezierPoints b = spline_spans(spline)[span];
  const double u = 1 - t;
  Point2 at{};
  for (std::size_t k = 0; k < 2; ++k)
    at[k] = u * u * u * b[0][k] + 3 * u * u * t * b[1][k] + 3 * u * t * t * b[2][k] + t * t * t * b[3][k];
  const Point2 along = bezier_derivatives(b, t).first_m;
  return 0.7 * at[0] - 1.3 * at[1] + 0.4 * std::atan2(along[1], along[0]);
}

// The whole gradient in one pass backwards through the spline's rows equals differences of the spline.
TEST(SplineSlopes, AreTheDerivativesByEveryVariable) {
  std::mt19937 random(11);
  std::uniform_real_distribution<> share(0.05, 0.95);
  for (std::size_t points = 2; points < 12; ++points) {
    const FreeSpline spline = bent_spline(random, points);
    const std::size_t span = random() % (points - 1);
    const double t = share(random);
    const SplineSlopes slopes =
        spline_slopes(spline, {.span = span, .t = t, .by_x_m = 0.7, .by_y_m = -1.3, .by_heading_rad = 0.4});
    const auto expect_slope = [&](double slope, auto&& member) {
      constexpr double kStep = 1e-5;
      FreeSpline low = spline, high = spline;
      member(low) -= kStep;
      member(high) += kStep;
      EXPECT_NEAR(slope, (seen_at(high, span, t) - seen_at(low, span, t)) / (2 * kStep), 1e-7) << points;
    };
    expect_slope(slopes.by_start_heading_rad, [](FreeSpline& s) -> double& { return s.start_heading_rad; });
    expect_slope(slopes.by_start_handle_m, [](FreeSpline& s) -> double& { return s.start_handle_m; });
    expect_slope(slopes.by_goal_heading_rad, [](FreeSpline& s) -> double& { return s.goal_heading_rad; });
    expect_slope(slopes.by_goal_handle_m, [](FreeSpline& s) -> double& { return s.goal_handle_m; });
    for (std::size_t i = 0; i < points; ++i)
      for (std::size_t k = 0; k < 2; ++k)
        expect_slope(slopes.by_point_m[i][k], [&](FreeSpline& s) -> double& { return s.points_m[i][k]; });
  }
}

}  // namespace
}  // namespace joulepath
