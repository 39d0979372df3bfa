#include "planner/path/shape/waypoint_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/planner/path/curve_laws.hpp"

namespace joulepath {
namespace {

/// A bent track with uneven spacing.
const std::vector<Point2> kTrack{{0, 0}, {0.4, 0.1}, {2, 0.5}, {2.5, 1.5}, {1.5, 3}, {1.45, 3.2}, {3, 5}};

double distance_m(const PathPiece& piece, const Point2& point_m) {
  double least_m = 1e9;
  constexpr int kSamples = 20000;
  for (int k = 0; k <= kSamples; ++k) {
    const Pose pose = piece_point(piece, piece_length(piece) * k / kSamples).pose;
    least_m = std::min(least_m, std::hypot(pose.x_m - point_m[0], pose.y_m - point_m[1]));
  }
  return least_m;
}

TEST(WaypointPath, ACurvePassesAllWaypointsInOnePieceWithContinuousCurvature) {
  const WaypointPath along = curve_through(kTrack);
  ASSERT_FALSE(along.defect);
  ASSERT_EQ(along.path.pieces.size(), 1u) << "no stop";
  const PathPiece& piece = along.path.pieces.front();
  for (const Point2& point : kTrack) EXPECT_LT(distance_m(piece, point), 5e-4);
  const CurveBreach breach = curve_breach(piece);
  EXPECT_LT(breach.position_m, 1e-9);
  EXPECT_LT(breach.curvature_per_m, 1e-6);
  EXPECT_LT(breach.curvature_step_per_m, 1e-6);
  EXPECT_NEAR(piece_point(piece, 0).curvature_per_m, 0, 1e-9) << "natural at its ends";
  EXPECT_NEAR(piece_point(piece, piece_length(piece)).curvature_per_m, 0, 1e-9);
}

TEST(WaypointPath, WaypointsOfACircleGiveItsCurvature) {
  std::vector<Point2> circle_m;
  for (int k = 0; k <= 40; ++k) circle_m.push_back({2 * std::cos(0.05 * k), 2 * std::sin(0.05 * k)});
  const WaypointPath along = curve_through(circle_m);
  ASSERT_FALSE(along.defect);
  const PathPiece& piece = along.path.pieces.front();
  EXPECT_NEAR(piece_point(piece, 0.5 * piece_length(piece)).curvature_per_m, 0.5, 2e-4);
}

TEST(WaypointPath, CornersKeepTheirRadiusAndWithoutOneTheRobotTurns) {
  const WaypointPath along = lines_between({{0, 0}, {3, 0}, {3, 3}, {6, 3}}, {0, 0.5, 0, 0});
  ASSERT_FALSE(along.defect);
  ASSERT_EQ(along.path.pieces.size(), 3u);
  EXPECT_TRUE(is_turn(along.path.pieces[1]));
  const PathPiece& bend = along.path.pieces.front();
  double most_per_m = 0;
  for (int k = 0; k <= 2000; ++k)
    most_per_m =
        std::max(most_per_m, std::abs(piece_point(bend, piece_length(bend) * k / 2000).curvature_per_m));
  EXPECT_NEAR(most_per_m, 1 / 0.5, 1e-6);
  EXPECT_LT(curve_breach(bend).curvature_step_per_m, 1e-9);
  EXPECT_NEAR(along.path.end().x_m, 6, 1e-9);
  EXPECT_NEAR(along.path.end().y_m, 3, 1e-9);
}

TEST(WaypointPath, TheLargestRadiusThatItAcceptsFitsAndNoLargerOne) {
  const std::vector<Point2> corner_m{{0, 0}, {3, 0}, {3, 2}};
  const WaypointPath wide = lines_between(corner_m, {0, 5, 0});
  ASSERT_TRUE(wide.defect);
  EXPECT_EQ(wide.defect->waypoint, 1u);
  const double most_m = std::stod(wide.defect->accepted.substr(std::string("at most ").size()));
  EXPECT_FALSE(lines_between(corner_m, {0, 0.999 * most_m, 0}).defect) << wide.defect->accepted;
  EXPECT_TRUE(lines_between(corner_m, {0, 1.001 * most_m, 0}).defect);
}

TEST(WaypointPath, TheRadiusThatAMessageProposesIsAccepted) {
  for (double chord_m : {2.0, 3.0, 5.0, 7.3}) {
    const std::vector<Point2> corner_m{{0, 0}, {chord_m, 0}, {chord_m, chord_m}};
    const WaypointPath wide = lines_between(corner_m, {0, 20, 0});
    ASSERT_TRUE(wide.defect);
    const double most_m = std::stod(wide.defect->accepted.substr(std::string("at most ").size()));
    EXPECT_FALSE(lines_between(corner_m, {0, most_m, 0}).defect) << chord_m << ": " << wide.defect->accepted;
  }
}

TEST(WaypointPath, ACurveThatLeadsStraightBackTurnsInPlace) {
  const WaypointPath there_and_back = curve_through({{0, 0}, {3, 0}, {0, 0}});
  ASSERT_FALSE(there_and_back.defect) << there_and_back.defect->found;
  ASSERT_EQ(there_and_back.path.pieces.size(), 3u);
  EXPECT_NEAR(there_and_back.path.turned_rad(), M_PI, 1e-9);
  EXPECT_NEAR(there_and_back.path.distance_m(), 6, 1e-9);
  const Path bent = curve_through({{0, 0}, {1, 0.5}, {3, 0}, {1, 0.5}, {0, 2}}).path;
  ASSERT_EQ(bent.pieces.size(), 3u);
  for (std::size_t i = 0; i + 1 < bent.pieces.size(); ++i) {
    const Pose end = piece_point(bent.pieces[i], piece_length(bent.pieces[i])).pose;
    const Pose begin = piece_point(bent.pieces[i + 1], 0).pose;
    EXPECT_NEAR(std::hypot(end.x_m - begin.x_m, end.y_m - begin.y_m), 0, 1e-9);
  }
  const auto& turn = std::get<TurnInPlace>(bent.pieces[1]);
  const Pose end = piece_point(bent.pieces[2], 0).pose;
  EXPECT_NEAR(wrapped_angle_rad(turn.start.heading_rad + turn.angle_rad - end.heading_rad), 0, 1e-9);
}

/// A winding track of a length, sampled at steps, with noise of its coordinates.
std::vector<Point2> winding_m(double length_m, double step_m, double noise_m) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1);
  std::vector<Point2> points_m;
  for (double x = 0; x <= length_m + 1e-9; x += step_m)
    points_m.push_back({x + noise_m * noise(random), 3 * std::sin(x / 8) + noise_m * noise(random)});
  return points_m;
}

std::size_t spans_of(const Path& path) {
  std::size_t spans = 0;
  for (const PathPiece& piece : path.pieces)
    if (!is_turn(piece)) spans += std::get<Curve>(piece).segments().size();
  return spans;
}

/// Largest distance of a point from the path, in the order of both.
double farthest_m(const Path& path, const std::vector<Point2>& points_m) {
  double farthest = 0, s = 0;
  const PathPiece& piece = path.pieces.front();
  for (const Point2& point : points_m) {
    double nearest = 1e9, at = s;
    for (double t = std::max(0.0, s - 0.1); t < s + 0.3; t += 0.002) {
      const Pose pose = piece_point(piece, t).pose;
      const double distance = std::hypot(pose.x_m - point[0], pose.y_m - point[1]);
      if (distance < nearest) nearest = distance, at = t;
    }
    s = at;
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(WaypointPath, DenseWaypointsAreFollowedWithinTheToleranceAndTheirNoiseIsNot) {
  for (const double noise_m : {0.0, 0.002}) {
    const std::vector<Point2> points_m = winding_m(60, 0.05, noise_m);
    const WaypointPath along = curve_through(points_m);
    ASSERT_FALSE(along.defect) << along.defect->found;
    ASSERT_EQ(along.path.pieces.size(), 1u);
    EXPECT_LT(farthest_m(along.path, points_m), 0.0101);
    EXPECT_NEAR(along.path.start().x_m, points_m.front()[0], 1e-9);
    EXPECT_NEAR(along.path.end().y_m, points_m.back()[1], 1e-9);
    const CurveBreach breach = curve_breach(along.path.pieces.front());
    EXPECT_LT(breach.curvature_step_per_m, 1e-6);
    double most_per_m = 0;
    for (double s = 0; s < along.path.distance_m(); s += 0.01)
      most_per_m = std::max(most_per_m, std::abs(piece_point(along.path.pieces.front(), s).curvature_per_m));
    EXPECT_NEAR(most_per_m, 3.0 / 64, 0.015) << "of the sine; through noise of 2 mm it would be 5 1/m";
  }
}

TEST(WaypointPath, TheSizeOfASmoothedPathIsThatOfItsShapeNotOfItsWaypoints) {
  const std::size_t at_5_cm = spans_of(curve_through(winding_m(60, 0.05, 0)).path);
  EXPECT_LT(at_5_cm, 60u);
  for (const double step_m : {0.02, 0.005, 0.001})
    EXPECT_LE(spans_of(curve_through(winding_m(60, step_m, 0)).path), 2 * at_5_cm);
}

TEST(WaypointPath, AToleranceOfZeroPassesEveryWaypoint) {
  const std::vector<Point2> points_m = winding_m(5, 0.05, 0.002);
  const WaypointPath along = curve_through(points_m, 0);
  ASSERT_FALSE(along.defect);
  EXPECT_EQ(spans_of(along.path), points_m.size() - 1);
}

TEST(WaypointPath, ADenseCornerIsRoundedWithinTheToleranceAndADenseReversalIsATurn) {
  std::vector<Point2> corner_m, there_and_back_m;
  for (int i = 0; i <= 100; ++i) corner_m.push_back({0.05 * i, 0});
  for (int i = 1; i <= 100; ++i) corner_m.push_back({5, 0.05 * i});
  const WaypointPath rounded = curve_through(corner_m);
  ASSERT_FALSE(rounded.defect) << rounded.defect->found;
  EXPECT_LT(farthest_m(rounded.path, corner_m), 0.0101);
  for (int i = 0; i <= 300; ++i) there_and_back_m.push_back({0.01 * i, 1e-4 * (i % 3)});
  for (int i = 299; i >= 0; --i) there_and_back_m.push_back({0.01 * i, 1e-4 * (i % 2)});
  const WaypointPath back = curve_through(there_and_back_m);
  ASSERT_FALSE(back.defect) << back.defect->found;
  EXPECT_NEAR(back.path.turned_rad(), M_PI, 0.02);
  EXPECT_NEAR(back.path.distance_m(), 6, 0.01);
}

TEST(WaypointPath, ARobotThatStoodWhileItsPathWasRecordedIsFine) {
  std::vector<Point2> points_m = winding_m(10, 0.05, 0);
  points_m.insert(points_m.begin() + 80, 500, points_m[80]);
  EXPECT_FALSE(curve_through(points_m).defect);
}

TEST(WaypointPath, WaypointsThatNoRobotCanFollowAreNamed) {
  const auto waypoint_of = [](const WaypointPath& along) {
    return along.defect ? static_cast<int>(along.defect->waypoint) : -1;
  };
  EXPECT_EQ(waypoint_of(curve_through({{1, 1}})), 0);
  EXPECT_EQ(waypoint_of(curve_through({{0, 0}, {1, 0}, {1, 0}, {2, 0}})), 2);
  EXPECT_EQ(waypoint_of(curve_through({{0, 0}, {1, 0}, {0.5, 0}, {2, 0}})), -1) << "back and forth";
  EXPECT_EQ(waypoint_of(lines_between({{0, 0}, {1, 0}, {0, 0}}, {0, 0.1, 0})), 1);
  EXPECT_EQ(waypoint_of(lines_between({{0, 0}, {1, 0}, {0, 0}}, {0, 0, 0})), -1) << "half a turn on the spot";
}

}  // namespace
}  // namespace joulepath
