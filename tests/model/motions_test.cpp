#include "model/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/config_error.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

constexpr BezierPoints kPaperCurve{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}};  // [P1, Eq. (34)]

double top_speed_m_s(const Trajectory& t) {
  return *std::max_element(t.linear_speed_m_s.begin(), t.linear_speed_m_s.end());
}

TEST(Motions, ConstantRampCoversItsDistanceAndEndsAtRest) {
  const PrescribedMotion ramp{
      .profile = MotionProfile::constant_ramp, .acceleration_m_s2 = 0.2, .ramp_s = 4, .distance_m = 10};
  const Trajectory t = timed_motion(nomad(), {ramp}).trajectory;
  EXPECT_NEAR(t.position_x_m.back(), 10.0, 1e-9);
  EXPECT_NEAR(top_speed_m_s(t), 0.8, 1e-12);
  EXPECT_NEAR(t.linear_speed_m_s.back(), 0.0, 1e-12);
  EXPECT_NEAR(t.time_s.back(), 4 + (10 - 1.6 - 1.6) / 0.8 + 4, 1e-9);
}

TEST(Motions, WithoutRoomATrapezoidIsATriangle) {
  const PrescribedMotion motion{.profile = MotionProfile::trapezoid,
                                .acceleration_m_s2 = 0.5,
                                .deceleration_m_s2 = 0.25,
                                .speed_m_s = 1.0,
                                .distance_m = 0.6,
                                .reverse = true};
  const Trajectory t = timed_motion(nomad(), {motion}).trajectory;
  EXPECT_NEAR(t.position_x_m.back(), -0.6, 1e-9);
  const double peak = std::sqrt(2 * 0.6 * 0.5 * 0.25 / 0.75);
  EXPECT_NEAR(*std::min_element(t.linear_speed_m_s.begin(), t.linear_speed_m_s.end()), -peak, 1e-12);
}

TEST(Motions, SpinAndArcTurnByTheirAngle) {
  const PrescribedMotion spin{.profile = MotionProfile::spin, .angle_rad = -3.0};
  const PrescribedMotion arc{
      .profile = MotionProfile::arc, .speed_m_s = 0.4, .radius_m = 1.5, .angle_rad = std::numbers::pi / 2};
  const Trajectory a = timed_motion(nomad(), {spin}).trajectory;
  EXPECT_NEAR(a.heading_rad.back(), -3.0, 1e-9);
  EXPECT_NEAR(std::hypot(a.position_x_m.back(), a.position_y_m.back()), 0.0, 1e-12);
  const Trajectory b = timed_motion(nomad(), {arc}).trajectory;
  EXPECT_NEAR(b.heading_rad.back(), std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(b.position_x_m.back(), 1.5, 1e-9);
  EXPECT_NEAR(b.position_y_m.back(), 1.5, 1e-9);
}

TEST(Motions, BezierEndsAtItsLastControlPoint) {
  const PrescribedMotion motion{.profile = MotionProfile::constant_ramp,
                                .acceleration_m_s2 = 0.2,
                                .start_speed_m_s = 0.3,
                                .ramp_s = 4,
                                .bezier_m = {kPaperCurve}};
  const Trajectory t = timed_motion(nomad(), {motion}, {.sample_period_s = 0.005}).trajectory;
  EXPECT_NEAR(t.position_x_m.back(), 2.7, 2e-5);
  EXPECT_NEAR(t.position_y_m.back(), 2.7, 2e-5);
  EXPECT_NEAR(t.heading_rad.back(), std::numbers::pi / 2, 2e-5);
}

TEST(Motions, EachMayHaveItsOwnPayload) {
  const PrescribedMotion stand{.profile = MotionProfile::stand, .duration_s = 2};
  const Trajectory t =
      timed_motion(nomad(), {stand, stand}, {.payload_kg = 9, .payload_of_motion_kg = {1, 4}}).trajectory;
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_EQ(t.payload_kg[k], t.time_s[k] < 2 + 1e-9 ? 1.0 : 4.0) << t.time_s[k];
}

TEST(Motions, RepeatedRampsAndStandsAreChained) {
  const PrescribedMotion ramp{.profile = MotionProfile::constant_ramp,
                              .acceleration_m_s2 = 0.2,
                              .deceleration_m_s2 = 0.8,
                              .ramp_s = 4,
                              .repeat = 5};
  const PrescribedMotion stand{.profile = MotionProfile::stand, .duration_s = 2.5};
  const Trajectory t = timed_motion(nomad(), {ramp, stand}, {.payload_kg = 3}).trajectory;
  EXPECT_NEAR(t.position_x_m.back(), 5 * (1.6 + 0.4), 1e-9);
  EXPECT_NEAR(t.time_s.back(), 5 * 5.0 + 2.5, 1e-9);
  EXPECT_TRUE(std::is_sorted(t.time_s.begin(), t.time_s.end()));
  EXPECT_EQ(std::adjacent_find(t.time_s.begin(), t.time_s.end()), t.time_s.end());
  EXPECT_EQ(t.payload_kg.back(), 3);
}

/// M dv/dt = -(F + c v) from v0 to rest takes M/c ln(1 + c v0/F).
TEST(Motions, CoastingAgainstViscousFrictionEndsInTheClosedForm) {
  Robot robot = testing::nomad();
  const double r = 0.1;
  double force_N = 0, slope_N_s_m = 0, mass_kg = robot.total_mass_kg(0.0);
  for (Side side : kSides) {
    robot.motor[side].viscous_friction_Nm_s_rad = 0.05;
    force_N += robot.motor[side].friction_torque_Nm / r;
    slope_N_s_m += 0.05 / (r * r);
    mass_kg += robot.inertia.wheel_axle_inertia_kg_m2 / (r * r);
  }
  const TimedMotion motion = timed_motion(robot, {{.profile = MotionProfile::coast, .speed_m_s = 0.8}});
  ASSERT_EQ(motion.coasting.size(), 1u);
  const double exact_s = mass_kg / slope_N_s_m * std::log(1 + slope_N_s_m * 0.8 / force_N);
  EXPECT_NEAR(motion.coasting[0].to_s, exact_s, 1e-4 * exact_s);
}

TEST(Motions, CoastingLosesItsKineticEnergyToFriction) {
  Robot robot = nomad();
  for (Side side : kSides) robot.motor[side].viscous_friction_Nm_s_rad = 0;
  const PrescribedMotion coast{.profile = MotionProfile::coast, .speed_m_s = 0.8};
  const TimedMotion motion = timed_motion(robot, {coast});
  const double mass_kg = 21.2 + 2 * 1.39 + 2 * 0.0281 / 0.01;
  const double deceleration_m_s2 = (0.3728 + 0.346) / 0.1 / mass_kg;
  EXPECT_NEAR(motion.trajectory.position_x_m.back(), 0.8 * 0.8 / (2 * deceleration_m_s2), 1e-6);
  ASSERT_EQ(motion.coasting.size(), 1u);
  EXPECT_NEAR(motion.coasting[0].to_s, 0.8 / deceleration_m_s2, 1e-6);
}

TEST(Motions, MissingAndImpossibleValuesAreRefused) {
  const PrescribedMotion no_ramp{.profile = MotionProfile::constant_ramp, .distance_m = 10};
  EXPECT_THROW((void)timed_motion(nomad(), {no_ramp}), ConfigError);
  const PrescribedMotion too_fast{
      .profile = MotionProfile::trapezoid, .start_speed_m_s = 1, .distance_m = 0.1};
  EXPECT_THROW((void)timed_motion(nomad(), {too_fast}), ConfigError);
  const PrescribedMotion stand{.profile = MotionProfile::stand, .duration_s = 1};
  const PrescribedMotion moving{.profile = MotionProfile::constant_speed, .speed_m_s = 0.5, .distance_m = 1};
  EXPECT_THROW((void)timed_motion(nomad(), {stand, moving}), ConfigError);
}

}  // namespace
}  // namespace joulepath
