#include "planner/motion/driven_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "model/assert.hpp"
#include "planner/motion/replay.hpp"
#include "planner/path/shape/corner_blend.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath {
namespace {

/// A curve of segments; nothing where their rounding breaks its continuity, which its constructor asserts.
std::optional<PathPiece> curve_of(std::vector<CurveSegment> segments) try {
  return Curve(std::move(segments));
} catch (const InternalError&) {
  return std::nullopt;
}

/// 3 m, a corner on a blend of a radius, 3 m.
std::optional<PathPiece> cornered(double angle_rad, double radius_m) {
  const BlendShape shape = blend_shape(angle_rad);
  std::vector<CurveSegment> segments{LinearCurvature({}, 3.0 - radius_m * shape.tangent)};
  for (CurveSegment& segment : blend_segments({3, 0}, 0, shape, radius_m)) segments.push_back(segment);
  const double back_m = radius_m * shape.tangent;
  segments.push_back(LinearCurvature(
      {3 + back_m * std::cos(angle_rad), back_m * std::sin(angle_rad), angle_rad}, 3.0 - back_m));
  return curve_of(std::move(segments));
}

ProfileRequest request_on(PathPiece piece) {
  const Robot robot = testing::nomad();
  return {.piece = std::move(piece),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .nodes = 40,
          .solver = SolverChoice::fast};
}

/// Whether the replay believes the drive that passes the corner at full speed, as if the path were straight.
bool believed_at_full_speed(const PathPiece& piece) {
  const Profile straight = *solve_profile(request_on(straight_piece({}, piece_length(piece)))).profile;
  return replay(request_on(piece), straight).valid();
}

/// From a tenth of a meter down to the least number: no corner is passed at full speed.
TEST(DrivenPose, NoRadiusHidesACornerFromTheReplay) {
  int judged = 0;
  for (const double angle_rad : {0.5 * std::numbers::pi, -0.7})
    for (int decade = 1; decade <= 320; decade += decade < 24 ? 1 : 37) {
      const double radius_m = std::pow(10.0, -decade);
      SCOPED_TRACE(radius_m);
      const std::optional<PathPiece> piece = cornered(angle_rad, radius_m);
      if (!piece) continue;
      EXPECT_FALSE(believed_at_full_speed(*piece));
      ++judged;
    }
  EXPECT_GE(judged, 12) << "radii whose curve is one";
}

/// The same kind of corner as a cubic that begins and ends without curvature.
TEST(DrivenPose, ATinyCubicHidesNoCorner) {
  int judged = 0;
  for (int decade = 1; decade <= 12; ++decade) {
    const double size_m = std::pow(10.0, -decade);
    SCOPED_TRACE(size_m);
    const BezierPoints corner{{{3, 0}, {3 + size_m, 0}, {3 + size_m, 0}, {3 + size_m, size_m}}};
    const Pose behind{3 + size_m, size_m, 0.5 * std::numbers::pi};
    const std::optional<PathPiece> piece = curve_of(
        {LinearCurvature({}, 3.0), BezierSegment(corner), LinearCurvature(behind, 3.0)});
    if (!piece) continue;
    EXPECT_FALSE(believed_at_full_speed(*piece));
    ++judged;
  }
  EXPECT_GE(judged, 3) << "cubics whose curve is one";
}

TEST(DrivenPose, CurvatureLeadsToTheEndOfEveryOrdinaryPath) {
  testing::RandomProfiles random(12);
  for (const testing::PathClass path_class : testing::kPathClasses)
    for (int k = 0; k < 20; ++k) EXPECT_TRUE(leads_to_its_end(random.next(path_class).piece));
  const LinearCurvature rise({1, 2, 0.3}, 2.0, 0.0, 0.4);
  const Curve back({rise, LinearCurvature(rise.at(2.0).pose, 1.0, 0.8)}, Direction::reverse);
  EXPECT_TRUE(leads_to_its_end(back));
  EXPECT_TRUE(leads_to_its_end(TurnInPlace{{1, 2, 0.3}, -2.0}));
}

TEST(DrivenPose, AReplayThatDoesNotArriveIsNoPlan) {
  const ProfileRequest request = request_on(straight_piece({}, 2.0));
  Profile profile = *solve_profile(request).profile;
  ASSERT_TRUE(replay(request, profile).valid());
  ProfileRequest longer = request_on(straight_piece({}, 2.1));
  EXPECT_EQ(replay(longer, profile).limit, "path");
  EXPECT_FALSE(replay(longer, profile).valid());
  profile.acceleration[3] = std::nan("");
  EXPECT_FALSE(replay(request, profile).valid());
}

TEST(WaypointPath, ARadiusIsALengthOrZero) {
  const std::vector<Point2> corner_m{{0, 0}, {3, 0}, {3, 3}};
  EXPECT_FALSE(lines_between(corner_m, {0, kLeastCornerRadius_m, 0}).defect);
  EXPECT_FALSE(lines_between(corner_m, {0, 0, 0}).defect);
  for (const double radius_m : {-0.1, 0.0099, 1e-16, 1e-100, 5e-324, std::nan("")})
    EXPECT_TRUE(lines_between(corner_m, {0, radius_m, 0}).defect) << radius_m;
}

}  // namespace
}  // namespace joulepath
