#include "planner/path/geometry/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/assert.hpp"
#include "tests/planner/path/curve_laws.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

TEST(LinearCurvature, StraightStaysExactlyOnItsLine) {
  const LinearCurvature line({1.0, -2.0, 0.0}, 7.5);
  for (const double s : {0.0, 0.1, 3.0, 7.5}) {
    EXPECT_EQ(line.at(s).pose.x_m, 1.0 + s);
    EXPECT_EQ(line.at(s).pose.y_m, -2.0);
    EXPECT_EQ(line.at(s).curvature_per_m, 0.0);
  }
}

TEST(LinearCurvature, ArcStaysAtItsRadius) {
  const double radius_m = 0.7;
  const LinearCurvature arc({0, 0, 0}, 2 * pi * radius_m, 1 / radius_m);
  for (int i = 0; i <= 100; ++i) {
    const Pose p = arc.at(arc.length_m() * i / 100).pose;
    EXPECT_NEAR(std::hypot(p.x_m, p.y_m - radius_m), radius_m, 1e-14);
  }
}

TEST(LinearCurvature, ClothoidEndsWhereFresnelIntegralsSay) {
  // kappa' = pi, from zero curvature: x(1) = C(1), y(1) = S(1) of the normalized Fresnel integrals.
  const Pose end = LinearCurvature({0, 0, 0}, 1.0, 0.0, pi).at(1.0).pose;
  EXPECT_NEAR(end.x_m, 0.77989340037682282947, 1e-14);
  EXPECT_NEAR(end.y_m, 0.43825914739035476608, 1e-14);
}

TEST(Curve, ChannelsAreEachOthersIntegrals) {
  const LinearCurvature in({0, 0, 0.3}, 0.8, 0.0, 2.5);
  const LinearCurvature arc(in.at(0.8).pose, 1.1, 2.0);
  const LinearCurvature out(arc.at(1.1).pose, 0.5, 2.0, -4.0);
  for (const Direction direction : {Direction::forward, Direction::reverse}) {
    const CurveBreach breach = curve_breach(Curve({in, arc, out}, direction));
    EXPECT_LT(breach.position_m, 1e-12);
    EXPECT_LT(breach.heading_rad, 1e-12);
    EXPECT_LT(breach.curvature_per_m, 1e-12);
  }
}

TEST(Curve, BendsAsItsPointsDo) {
  const LinearCurvature in({0, 0, 0.3}, 0.8, 0.0, 2.5);
  const LinearCurvature arc(in.at(0.8).pose, 1.1, 2.0);
  const BezierSegment swing(BezierPoints{{{0, 0}, {-0.1, 0.05}, {0.1, 0.9}, {3, 0}}});
  for (const Direction direction : {Direction::forward, Direction::reverse})
    for (const Curve& curve : {Curve({in, arc}, direction), Curve({swing}, direction)})
      for (int i = -1; i <= 101; ++i) {
        const double s_m = curve.length_m() * i / 100;
        const PathPoint point = curve.at(s_m);
        EXPECT_NEAR(curve.bend(s_m).curvature_per_m, point.curvature_per_m, 1e-12);
        EXPECT_NEAR(curve.bend(s_m).curvature_slope_per_m2, point.curvature_slope_per_m2, 1e-9);
      }
}

TEST(Curve, RefusesSegmentsThatDoNotMeet) {
  const LinearCurvature a({0, 0, 0}, 1.0);
  EXPECT_THROW(Curve({a, LinearCurvature({1.1, 0, 0}, 1.0)}), InternalError);
  EXPECT_THROW(Curve({a, LinearCurvature({1.0, 0, 0.1}, 1.0)}), InternalError);
  EXPECT_THROW(Curve({a, LinearCurvature({1.0, 0, 0}, 1.0, 0.5)}), InternalError);
  EXPECT_NO_THROW(Curve({a, LinearCurvature({1.0, 0, 2 * pi}, 1.0)}));
}

TEST(Path, ReverseDrivesAgainstTheHeading) {
  const PathPiece piece = straight_piece({2, 3, pi / 2}, 1.5, Direction::reverse);
  const Pose end = piece_point(piece, piece_length(piece)).pose;
  EXPECT_NEAR(end.x_m, 2.0, 1e-15);
  EXPECT_NEAR(end.y_m, 1.5, 1e-15);
  EXPECT_NEAR(wrapped_angle_rad(end.heading_rad - pi / 2), 0.0, 1e-15);
  EXPECT_EQ(travel_sign(piece), -1);
}

TEST(Path, TurnsTheShorterWayRound) {
  Path path;
  append_turn_to(path, {1, 1, 3.0}, -3.0);
  ASSERT_EQ(path.pieces.size(), 1u);
  EXPECT_NEAR(path.turned_rad(), 2 * pi - 6.0, 1e-15);
  EXPECT_EQ(turn_sign(path.pieces[0]), 1);
  append_turn_to(path, {}, -3.0);
  EXPECT_EQ(path.pieces.size(), 1u);
  EXPECT_NEAR(wrapped_angle_rad(path.end().heading_rad + 3.0), 0.0, 1e-15);
}

}  // namespace
}  // namespace joulepath
