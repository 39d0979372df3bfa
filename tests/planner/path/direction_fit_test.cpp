#include "planner/path/shape/direction_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "planner/path/geometry/segment_ends.hpp"
#include "planner/path/shape/pose_path.hpp"

namespace joulepath {
namespace {

constexpr double kTrack_m = 0.18;  // not that of the fit

/// A drive that leaves and reaches its places nearly turning in place, with knots of its own: angles phi
/// along a sine, seeded.
std::vector<CurveSegment> drawn_drive(unsigned seed, double from_rad = 1.3, double to_rad = -1.2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(0, 1);
  const int count = 24;
  const double wave = 0.4 * draw(random), turns = 1 + 2 * draw(random), length_m = 0.1 + 0.2 * draw(random);
  const auto phi = [&](double share) {
    const double fade = std::pow(1 - share, 3), rise = std::pow(share, 3);
    return from_rad * fade + to_rad * rise + wave * std::sin(2 * std::numbers::pi * turns * share);
  };
  std::vector<CurveSegment> drive;
  Pose here{draw(random), draw(random), 6 * draw(random) - 3};
  for (int k = 0; k < count; ++k) {
    const DirectionSegment::Shape shape{phi(static_cast<double>(k) / count), phi((k + 1.0) / count), length_m,
                                        kTrack_m};
    drive.push_back(DirectionSegment(here, shape));
    here = end_of(drive.back()).pose;
  }
  return drive;
}

/// As a planner writes them: the same time apart, from rest to rest.
std::vector<Pose> poses_over_time(const Curve& curve, int count) {
  std::vector<Pose> poses;
  for (int k = 0; k <= count; ++k) {
    const double t = static_cast<double>(k) / count;
    Pose pose = curve.at(curve.length_m() * t * t * (3 - 2 * t)).pose;
    pose.heading_rad = wrapped_angle_rad(pose.heading_rad);
    poses.push_back(pose);
  }
  return poses;
}

/// The angle between driving and turning: what limits of wheels see of a curvature.
double driven_rad(const Curve& curve, double share) {
  return std::atan(kTrack_m * curve.at(share * curve.length_m()).curvature_per_m);
}

TEST(DirectionFit, PosesOfADriveGiveItBack) {
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const int count : {60, 150, 600}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << ", " << count << " poses");
      const Curve drawn(drawn_drive(seed));
      const std::optional<Curve> found =
          direction_fit(poses_over_time(drawn, count), 0.002, Direction::forward);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->length_m(), drawn.length_m(), 1e-3 * drawn.length_m());
      const Pose end = found->at(found->length_m()).pose, meant = drawn.at(drawn.length_m()).pose;
      EXPECT_NEAR(std::hypot(end.x_m - meant.x_m, end.y_m - meant.y_m), 0, 1e-9);
      EXPECT_NEAR(wrapped_angle_rad(end.heading_rad - meant.heading_rad), 0, 1e-9);
      for (const double share : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
        EXPECT_NEAR(driven_rad(*found, share), driven_rad(drawn, share), 0.03) << share;
    }
}

TEST(DirectionFit, MirroredPosesGiveTheMirroredCurve) {
  const Curve drawn(drawn_drive(3));
  std::vector<Pose> poses = poses_over_time(drawn, 100);
  const Curve found = direction_fit(poses, 0.002, Direction::forward).value();
  for (Pose& pose : poses) pose.y_m *= -1, pose.heading_rad *= -1;
  const Curve mirrored = direction_fit(poses, 0.002, Direction::forward).value();
  ASSERT_NEAR(mirrored.length_m(), found.length_m(), 1e-9);
  for (int k = 0; k <= 20; ++k) {
    const PathPoint a = found.at(found.length_m() * k / 20), b = mirrored.at(found.length_m() * k / 20);
    EXPECT_NEAR(a.pose.y_m, -b.pose.y_m, 1e-8) << k;
    EXPECT_NEAR(a.curvature_per_m, -b.curvature_per_m, 1e-6 * (1 + std::abs(a.curvature_per_m))) << k;
  }
}

TEST(DirectionFit, MeasuredPosesAreNotFollowed) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise;
  std::vector<Pose> poses = poses_over_time(Curve(drawn_drive(2)), 120);
  for (Pose& pose : poses)
    pose.x_m += 0.003 * noise(random), pose.y_m += 0.003 * noise(random),
        pose.heading_rad += 0.01 * noise(random);
  EXPECT_FALSE(direction_fit(poses, 0.002, Direction::forward));
}

/// Noise below the tolerance: 0.1 mm and 1 mrad on a line, whose curvature would shake.
TEST(PosePath, SmallNoiseIsNotExact) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    std::vector<Pose> poses;
    for (int k = 0; k <= 100; ++k)
      poses.push_back({0.02 * k + 1e-4 * noise(random), 1e-4 * noise(random), 1e-3 * noise(random)});
    const WaypointPath along = path_along_poses(poses);
    ASSERT_EQ(along.path.pieces.size(), 1u) << seed;
    EXPECT_FALSE(along.exact) << seed;
  }
}

/// Lines and arcs with poses 2.4 mm apart: the curvature steps, and the robot drives on.
TEST(PosePath, AStepOfTheCurvatureIsNoStop) {
  std::vector<Pose> poses;
  Pose here{};
  for (const auto& [length_m, bend_per_m] : {std::pair{1.2, 0.0}, {1.2, 1.0}, {0.6, 0.0}, {1.2, -1.0}})
    for (int k = 0; k < 500; ++k) {
      poses.push_back(here);
      const double step_m = length_m / 500, middle_rad = here.heading_rad + 0.5 * step_m * bend_per_m;
      here = {here.x_m + step_m * std::cos(middle_rad), here.y_m + step_m * std::sin(middle_rad),
              here.heading_rad + step_m * bend_per_m};
    }
  const WaypointPath along = path_along_poses(poses);
  ASSERT_FALSE(along.defect);
  EXPECT_EQ(along.path.pieces.size(), 1u);
}

TEST(PosePath, ALargeToleranceSmooths) {
  const std::vector<Pose> poses = poses_over_time(Curve(drawn_drive(1)), 200);
  EXPECT_TRUE(path_along_poses(poses).exact);
  EXPECT_FALSE(path_along_poses(poses, 0.03).exact);
}

/// Two drives, the second with another angle at once: no curve does both without a stop.
TEST(PosePath, AStopIsSeenWhereExactPosesTurnOtherwise) {
  const Curve first(drawn_drive(4, 0.9, 0.8));
  std::vector<CurveSegment> second;
  Pose here = first.at(first.length_m()).pose;
  for (const CurveSegment& segment : drawn_drive(5, -1.1, 0.5)) {
    second.push_back(DirectionSegment(here, std::get<DirectionSegment>(segment).shape()));
    here = end_of(second.back()).pose;
  }
  std::vector<Pose> poses = poses_over_time(first, 120);
  for (const Pose& pose : poses_over_time(Curve(second), 120)) poses.push_back(pose);
  const WaypointPath along = path_along_poses(poses);
  ASSERT_FALSE(along.defect);
  EXPECT_TRUE(along.exact);
  ASSERT_EQ(along.path.pieces.size(), 2u);
  EXPECT_NEAR(piece_length(along.path.pieces[0]), first.length_m(), 1e-3 * first.length_m());
}

}  // namespace
}  // namespace joulepath
