#include "model/kinematics.hpp"

#include <gtest/gtest.h>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

TEST(Kinematics, RollingIsThePapersConstraint) {
  Geometry geometry = testing::nomad().geometry;
  geometry.wheel_radius_m = {0.09, 0.11};
  const auto wheels = wheel_speeds_rad_s(geometry, 0.5, 0.8);
  EXPECT_NEAR(0.11 * wheels.right, 0.5 + 0.165 * 0.8, 1e-15);  // [P1, Eq. (2)]
  EXPECT_NEAR(0.09 * wheels.left, 0.5 - 0.165 * 0.8, 1e-15);   // [P1, Eq. (3)]
}

TEST(Kinematics, BodyTwistIsTheInverse) {
  Geometry geometry = testing::nomad().geometry;
  geometry.wheel_radius_m = {0.09, 0.11};
  const auto twist = body_twist(geometry, wheel_speeds_rad_s(geometry, -0.3, 1.2));
  EXPECT_NEAR(twist.speed_m_s, -0.3, 1e-15);
  EXPECT_NEAR(twist.yaw_rate_rad_s, 1.2, 1e-15);
}

TEST(Kinematics, ACourseIsNothingStraightOnAndOneInASpin) {
  const Geometry geometry = testing::nomad().geometry;
  EXPECT_EQ(course_of(geometry, 0.5, 0.0), 0.0);
  EXPECT_EQ(course_of(geometry, 0.0, 0.4), 1.0);
  EXPECT_EQ(course_of(geometry, 0.0, -0.4), -1.0);
  EXPECT_NEAR(course_of(geometry, 0.165, 1.0), std::sqrt(0.5), 1e-15);
}

}  // namespace
}  // namespace joulepath
