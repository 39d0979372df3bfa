#include "planner/path/shape/pose_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace joulepath {
namespace {

/// A path of curves, turns in place and a part in reverse, seeded.
Path drawn_path(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  Path path;
  Pose here{draw(-3, 3), draw(-3, 3), draw(-3, 3)};
  for (int k = 0; k < 4; ++k) {
    const bool reverse = k % 2 == 1;
    const double sign = reverse ? -1 : 1, c = std::cos(here.heading_rad), s = std::sin(here.heading_rad);
    const double a = draw(0.5, 1), x = draw(1.5, 2.5), y = draw(-1, 1), turn = draw(-0.8, 0.8);
    const auto at = [&](double along, double beside) {
      return std::array{here.x_m + sign * (c * along - s * beside),
                        here.y_m + sign * (s * along + c * beside)};
    };
    const BezierPoints points{
        {at(0, 0), at(a, 0), at(x - a * std::cos(turn), y - a * std::sin(turn)), at(x, y)}};
    path.pieces.emplace_back(
        Curve({BezierSegment(points)}, reverse ? Direction::reverse : Direction::forward));
    here = path.end();
    if (k == 1) {
      path.pieces.emplace_back(TurnInPlace{here, draw(-4, 4)});
      here = path.end();
    }
  }
  return path;
}

/// Poses along a path every `step` (m or rad).
std::vector<Pose> poses_along(const Path& path, double step) {
  std::vector<Pose> poses;
  for (const PathPiece& piece : path.pieces) {
    const double length = piece_length(piece);
    const int count = static_cast<int>(std::ceil(length / step));
    for (int k = 0; k <= count; ++k) {
      Pose pose = piece_point(piece, length * k / count).pose;
      if (const auto* turn = std::get_if<TurnInPlace>(&piece))
        pose = {turn->start.x_m, turn->start.y_m, turn->start.heading_rad + turn->angle_rad * k / count};
      poses.push_back({pose.x_m, pose.y_m, wrapped_angle_rad(pose.heading_rad)});
    }
  }
  return poses;
}

/// Too sharp for a spline: an arc of 0.2 mm, nearly a turn in place, at either end of a way of 1 m.
TEST(PosePath, KeepsTheHeadingsAtTheEndsOfAWayThatNoCurveFollows) {
  std::vector<Pose> poses;
  constexpr double kRadius_m = 2e-4, kTurn_rad = 1.4;
  for (int k = 0; k <= 24; ++k) {
    const double turned = kTurn_rad * k / 24;
    poses.push_back({kRadius_m * std::sin(turned), kRadius_m * (1 - std::cos(turned)), turned});
  }
  const Pose out = poses.back();
  for (int k = 1; k <= 100; ++k)
    poses.push_back(
        {out.x_m + 0.01 * k * std::cos(kTurn_rad), out.y_m + 0.01 * k * std::sin(kTurn_rad), kTurn_rad});
  const Pose in = poses.back();
  for (int k = 1; k <= 24; ++k) {
    const double turned = kTurn_rad * k / 24, heading = kTurn_rad - turned;
    poses.push_back({in.x_m + kRadius_m * (std::cos(heading - std::numbers::pi / 2) -
                                           std::cos(kTurn_rad - std::numbers::pi / 2)),
                     in.y_m + kRadius_m * (std::sin(heading - std::numbers::pi / 2) -
                                           std::sin(kTurn_rad - std::numbers::pi / 2)),
                     heading});
  }
  const Path path = path_along_poses(poses, kWaypointTolerance_m).path;
  ASSERT_FALSE(path.pieces.empty());
  EXPECT_NEAR(wrapped_angle_rad(path.start().heading_rad), 0, 0.1);
  EXPECT_NEAR(wrapped_angle_rad(path.end().heading_rad), 0, 0.1);
}

void expect_same_drive(const Path& found, const Path& drawn, double heading_rad) {
  ASSERT_EQ(found.pieces.size(), drawn.pieces.size());
  for (std::size_t k = 0; k < drawn.pieces.size(); ++k) {
    const PathPiece &a = found.pieces[k], &b = drawn.pieces[k];
    ASSERT_EQ(travel_sign(a), travel_sign(b)) << k;
    ASSERT_EQ(turn_sign(a), turn_sign(b)) << k;
    EXPECT_NEAR(piece_length(a), piece_length(b), 2e-3 * piece_length(b)) << k;
    for (int i = 0; i <= 20; ++i) {
      const Pose p = piece_point(a, piece_length(a) * i / 20).pose,
                 q = piece_point(b, piece_length(b) * i / 20).pose;
      EXPECT_NEAR(p.x_m, q.x_m, 0.01) << k << " " << i;
      EXPECT_NEAR(p.y_m, q.y_m, 0.01) << k << " " << i;
      EXPECT_NEAR(wrapped_angle_rad(p.heading_rad - q.heading_rad), 0, heading_rad) << k << " " << i;
    }
  }
}

TEST(PosePath, PosesOfAPathGiveItsCurvesTurnsAndDirections) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const double step : {0.005, 0.02, 0.05}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", step " << step);
      const Path drawn = drawn_path(seed);
      const WaypointPath along = path_along_poses(poses_along(drawn, step));
      ASSERT_FALSE(along.defect) << along.defect->found;
      expect_same_drive(along.path, drawn, 0.01);
      EXPECT_NEAR(wrapped_angle_rad(along.path.start().heading_rad - drawn.start().heading_rad), 0, 1e-9);
      EXPECT_NEAR(wrapped_angle_rad(along.path.end().heading_rad - drawn.end().heading_rad), 0, 1e-9);
    }
}

/// Noise of a localization: 2 mm and 10 mrad.
TEST(PosePath, NoiseIsNotFollowed) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise;
  Path drawn;
  drawn.pieces.emplace_back(Curve({BezierSegment(BezierPoints{{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}));
  std::vector<Pose> poses = poses_along(drawn, 0.02);
  for (std::size_t k = 1; k + 1 < poses.size(); ++k) {
    poses[k].x_m += 0.002 * noise(random), poses[k].y_m += 0.002 * noise(random);
    poses[k].heading_rad += 0.01 * noise(random);
  }
  const WaypointPath along = path_along_poses(poses);
  ASSERT_FALSE(along.defect);
  ASSERT_EQ(along.path.pieces.size(), 1u);
  double most_per_m = 0;
  const PathPiece& piece = along.path.pieces[0];
  for (int k = 0; k <= 500; ++k)
    most_per_m =
        std::max(most_per_m, std::abs(piece_point(piece, piece_length(piece) * k / 500).curvature_per_m));
  EXPECT_LT(most_per_m, 1.2) << "0.6 along the curve itself";
}

TEST(PosePath, HeadingsThatSayNothingAreLeftOut) {
  std::vector<Pose> poses;
  for (int k = 0; k <= 100; ++k) poses.push_back({2 * std::cos(0.02 * k), 2 * std::sin(0.02 * k), 0.0});
  const WaypointPath along = path_along_poses(poses);
  ASSERT_FALSE(along.defect);
  ASSERT_EQ(along.path.pieces.size(), 1u);
  EXPECT_EQ(travel_sign(along.path.pieces[0]), 1);
  EXPECT_NEAR(along.path.start().heading_rad, std::numbers::pi / 2, 0.02);
}

TEST(PosePath, TurnsAloneAreAPathAndAStandIsNone) {
  std::vector<Pose> poses;
  for (int k = 0; k <= 90; ++k) poses.push_back({1, 2, wrapped_angle_rad(0.1 * k)});
  const WaypointPath along = path_along_poses(poses);
  ASSERT_EQ(along.path.pieces.size(), 1u);
  EXPECT_NEAR(std::get<TurnInPlace>(along.path.pieces[0]).angle_rad, 9.0, 1e-9);
  EXPECT_TRUE(path_along_poses({{1, 2, 0}, {1, 2, 0}}).defect);
}

}  // namespace
}  // namespace joulepath
