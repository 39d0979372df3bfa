#include <gtest/gtest.h>

#include "extensions/onboard/replan/follow_drive.hpp"
#include "extensions/onboard/tests/situations.hpp"

namespace joulepath {
namespace {

using testing::planned;
using testing::PlannedPiece;

/// A straight, a bend to the left of 0.8 m radius by clothoids, and a straight; least energy in 1.2 times the
/// least time.
PlannedPiece bend(double slack = 1.3, const Robot& robot = testing::nomad()) {
  std::vector<CurveSegment> segments;
  Pose pose{};
  const auto append = [&](double length_m, double curvature, double slope) {
    segments.emplace_back(LinearCurvature(pose, length_m, curvature, slope));
    pose = std::get<LinearCurvature>(segments.back()).at(length_m).pose;
  };
  append(3, 0, 0);
  append(1, 0, 1.25);
  append(1, 1.25, -1.25);
  append(3, 0, 0);
  return *planned({.piece = Curve(std::move(segments)),
                   .plant = make_plant(robot),
                   .limits = *robot.limits,
                   .payload = {4.0, 4.0}},
                  slack);
}

PlannedPiece quarter_turn(const Robot& robot = testing::nomad()) {
  return *planned({.piece = TurnInPlace{{1, 2, 0.3}, -1.6},
                   .plant = make_plant(robot),
                   .limits = *robot.limits,
                   .payload = {4.0, 4.0}},
                  1.3);
}

/// 150 kg with a limit of jerk, as the robot file amr_150kg.yaml.
Robot heavy() {
  Robot robot = testing::nomad();
  const Motor motor{.gear_ratio = 12,
                    .resistance_ohm = 0.3,
                    .torque_constant_Nm_A = 0.1135,
                    .voltage_constant_V_s_rad = 0.1135,
                    .viscous_friction_Nm_s_rad = 0.02,
                    .friction_torque_Nm = 2.0,
                    .max_voltage_V = 24,
                    .max_current_A = 25};
  robot.motor = {motor, motor};
  robot.geometry = {.wheel_radius_m = {0.13, 0.13}, .half_track_m = 0.25, .center_of_mass_offset_m = -0.1};
  robot.inertia = {144, 3, 12.3, 0.03, 0.047, 0.013};
  robot.limits = Limits{.speed_m_s = 1.5,
                        .acceleration_m_s2 = 0.6,
                        .deceleration_m_s2 = 0.8,
                        .lateral_acceleration_m_s2 = 0.6,
                        .yaw_rate_rad_s = 1.5,
                        .yaw_acceleration_rad_s2 = 2.0,
                        .jerk_m_s3 = 1.5,
                        .traction_coefficient = 0.5,
                        .max_payload_kg = 80};
  robot.limits_by_payload.clear();
  robot.power = {.standby_W = 60, .regeneration_efficiency = 0.5};
  return robot;
}

FollowRequest request_for(const PlannedPiece& piece, std::vector<Disturbance> disturbances = {}) {
  const double end_s = piece.plan.time_s.back();
  return {.robot = piece.request.plant.robot,
          .pieces = {{&piece.request, &piece.plan, 0.0, end_s}},
          .start = piece_point(piece.request.piece, 0).pose,
          .end_s = end_s,
          .disturbances = std::move(disturbances)};
}

double planned_J(const PlannedPiece& piece) {
  return testing::exact_energy_J(path_motion(piece.request), piece.plan);
}

TEST(Projection, FindsTheFootOfThePerpendicular) {
  const PlannedPiece piece = bend();
  PathProjection projection(piece.request.piece);
  for (double s = 0.05; s < 7.9; s += 0.1) {
    const Pose foot = piece_point(piece.request.piece, s).pose;
    const double aside = 0.1 * std::sin(s);
    const Pose pose{foot.x_m - aside * std::sin(foot.heading_rad),
                    foot.y_m + aside * std::cos(foot.heading_rad), foot.heading_rad + 0.05};
    const PathOffset offset = projection.look(pose, 0.1);
    EXPECT_NEAR(offset.s, s, 1e-4);
    EXPECT_NEAR(offset.lateral_m, aside, 1e-5);
    EXPECT_NEAR(offset.heading_error_rad, 0.05, 1e-4);
  }
}

TEST(Follower, ArrivesInTimeAtThePlacesAndTheJoulesOfThePlan) {
  for (const PlannedPiece& piece : {bend(), quarter_turn()}) {
    const FollowResult result = follow(request_for(piece));
    EXPECT_EQ(result.finished, 1u);
    EXPECT_LT(result.late_s, 0.05);
    EXPECT_EQ(result.stopped_by, "");
    EXPECT_LT(result.end_error_m, 0.02);
    EXPECT_LT(result.end_error_rad, 0.03);
    EXPECT_LT(result.worst_lateral_m, 0.02);
    const double standby_W = piece.request.plant.robot.power.standby_W;
    const double motion_J = result.energy_J - standby_W * result.duration_s;
    const double planned_motion_J = planned_J(piece) - standby_W * piece.plan.time_s.back();
    EXPECT_NEAR(motion_J / planned_motion_J, 1, is_turn(piece.request.piece) ? 0.15 : 0.04);
  }
}

TEST(Follower, LeadsBackAfterASlipAndAPush) {
  const PlannedPiece piece = bend();
  for (const Disturbance& disturbance :
       {Disturbance{Disturbance::Kind::slip, 4, 0, 0.15}, Disturbance{Disturbance::Kind::push, 4, 1, -40}}) {
    const FollowResult result = follow(request_for(piece, {disturbance}));
    EXPECT_EQ(result.finished, 1u);
    EXPECT_LT(result.end_error_m, 0.03);
    EXPECT_LT(result.late_s, 0.8);
  }
}

/// No later than the fastest drive from the late start, which is in time for the first two.
TEST(Follower, MakesUpForALateStart) {
  const PlannedPiece piece = bend();
  const FollowResult undisturbed = follow(request_for(piece));
  const double deadline_s = piece.plan.time_s.back();
  const double least_s = testing::judge(piece.request, 0).least_time_s;
  for (const double late_s : {0.1, 0.3, 1.5}) {
    const FollowResult result = follow(request_for(piece, {{Disturbance::Kind::late_start, 0, 0, late_s}}));
    EXPECT_EQ(result.finished, 1u);
    EXPECT_GE(result.replans, 1u);
    EXPECT_LT(result.late_s, std::max(0.0, late_s + least_s - deadline_s) + 0.05) << late_s;
    EXPECT_GT(result.energy_J, undisturbed.energy_J);
  }
}

TEST(Follower, StandsBeforeAnObstacleAndGoesOn) {
  const PlannedPiece piece = bend(1.5);
  const FollowResult result = follow(request_for(piece, {{Disturbance::Kind::obstacle, 4, 8, 1.2}}));
  EXPECT_EQ(result.finished, 1u);
  double slowest = 1;
  for (std::size_t i = 0; i < result.executed.size(); ++i)
    if (result.executed.time_s[i] > 10.5 && result.executed.time_s[i] < 11.9)
      slowest = std::min(slowest, result.executed.linear_speed_m_s[i]);
  EXPECT_LT(slowest, 0.02);
  EXPECT_LT(result.end_error_m, 0.03);
}

TEST(Follower, KeepsASpeedLimit) {
  const PlannedPiece piece = bend();
  const FollowResult result = follow(request_for(piece, {{Disturbance::Kind::speed_limit, 3, 100, 0.25}}));
  for (std::size_t i = 0; i < result.executed.size(); ++i)
    if (result.executed.time_s[i] > 6) {
      EXPECT_LT(result.executed.linear_speed_m_s[i], 0.27);
    }
  EXPECT_EQ(result.finished, 1u);
}

/// What the commands used, by name.
double use_of(const FollowResult& result, std::string_view limit) {
  for (const LimitUse& use : result.limits)
    if (use.limit == limit) return use.fraction;
  ADD_FAILURE() << "no " << limit;
  return 0;
}

std::vector<Disturbance> any_disturbance() {
  using Kind = Disturbance::Kind;
  return {{Kind::push, 4, 1, -40},    {Kind::slip, 4, 0, 0.15},    {Kind::late_start, 0, 0, 1.5},
          {Kind::payload, 3, 1, 1.3}, {Kind::obstacle, 4, 4, 1.2}, {Kind::speed_limit, 3, 5, 0.3},
          {Kind::slip, 4, 0, 1.5}};
}

TEST(Follower, CommandsKeepTheLimits) {
  constexpr double kRounding = 1e-4;
  for (const Robot& robot : {testing::nomad(), heavy()})
    for (const double slack : {1.02, 1.3})
      for (const PlannedPiece& piece : {bend(slack, robot), quarter_turn(robot)}) {
        std::vector<std::vector<Disturbance>> cases{{}};
        for (const Disturbance& disturbance : any_disturbance()) cases.push_back({disturbance});
        for (const auto& disturbances : cases) {
          const FollowResult result = follow(request_for(piece, disturbances));
          const std::string what = robot.name + (is_turn(piece.request.piece) ? " turn " : " bend ") +
                                   std::to_string(disturbances.empty() ? -1 : int(disturbances[0].kind));
          EXPECT_TRUE(result.finished == 1u || result.off_path) << what;
          for (const char* limit :
               {"speed", "acceleration", "deceleration", "lateral_acceleration", "yaw_rate",
                "yaw_acceleration", "motor_voltage", "motor_current", "traction"})
            EXPECT_LE(use_of(result, limit), 1 + kRounding) << what << " " << limit;
          if (std::isfinite(robot.limits->jerk_m_s3)) {
            EXPECT_LE(use_of(result, "jerk"), 1 + kRounding) << what;
          }
        }
      }
}

/// New plans while the wheels turn by `excess_m_s` faster or slower in turn, from 2 s on, and the pose moves
/// by a share of that beside the plan.
std::size_t replans_with_wheels_off(double excess_m_s, double share_of_pose) {
  const PlannedPiece piece = bend();
  const double period_s = FollowerSettings{}.period_s;
  Follower follower(piece.request, piece.plan, kNoLimit);
  std::size_t replans = 0;
  double ahead_m = 0;
  for (int k = 0; k < 80; ++k) {
    const double time_s = k * period_s, excess = k < 40 ? 0.0 : k % 2 == 0 ? excess_m_s : -excess_m_s;
    const ProfileState due = piece.plan.at_time(time_s);
    ahead_m += share_of_pose * excess * period_s;
    const PathPoint at = piece_point(piece.request.piece, due.s + ahead_m);
    replans += follower
                   .command({.time_s = time_s,
                             .pose = at.pose,
                             .speed_m_s = due.rate + excess,
                             .yaw_rate_rad_s = due.rate * at.curvature_per_m,
                             .payload_kg = 4})
                   .replanned;
  }
  return replans;
}

TEST(Follower, WheelsThatSlipAreNotBelieved) {
  EXPECT_EQ(replans_with_wheels_off(0.4, 0), 0u);
  EXPECT_GE(replans_with_wheels_off(0.4, 1), 10u);
}

/// Known at 3 s: 40 kg where the robot may carry 12. It stands at the end, where the account ends.
TEST(Follower, StopsWithAPayloadThatTheRobotMayNotCarry) {
  const PlannedPiece piece = bend();
  const FollowRequest request = request_for(piece, {{Disturbance::Kind::payload, 2, 1, 10}});
  const FollowResult result = follow(request);
  ASSERT_TRUE(result.stopped);
  const Limits& limits = piece.request.limits;
  EXPECT_GT(result.stopped->time_s, 3.0);
  EXPECT_LT(result.stopped->time_s, 3.5 + 1.5 * limits.speed_m_s / limits.deceleration_m_s2);
  EXPECT_EQ(result.stopped->piece, 0u);
  EXPECT_NEAR(result.stopped->s, result.stopped->pose.x_m, 0.3);
  EXPECT_EQ(result.duration_s, result.stopped->time_s);
  EXPECT_NEAR(result.executed.time_s.back(), result.duration_s, 0.021);
  EXPECT_NEAR(result.executed.energy_J.back(), result.energy_J, 0.05 * result.energy_J);
  EXPECT_EQ(result.finished, 0u);
  EXPECT_EQ(result.stopped_by, "max_payload");
  EXPECT_FALSE(result.off_path);
  EXPECT_LT(std::abs(result.executed.linear_speed_m_s.back()), 0.01);
  EXPECT_LE(use_of(result, "deceleration"), 1 + 1e-4);
}

TEST(Follower, HandsOverFarFromThePath) {
  const PlannedPiece piece = bend();
  const FollowResult result = follow(request_for(piece, {{Disturbance::Kind::slip, 4, 0, 1.5}}));
  EXPECT_TRUE(result.off_path);
  EXPECT_EQ(result.finished, 0u);
  EXPECT_LT(std::abs(result.executed.linear_speed_m_s.back()), 0.05);
}

}  // namespace
}  // namespace joulepath
