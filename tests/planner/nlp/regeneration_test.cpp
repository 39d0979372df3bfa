// Power returned by braking wheels, for each wheel separately or on a common bus; wheels that turn backward.
#include <gtest/gtest.h>

#include <cmath>

#include "model/operating_point.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Straight, a tight bend with clothoids, straight.
PathPiece corner(double radius_m) {
  std::vector<CurveSegment> segments{LinearCurvature({}, 0.8)};
  const auto append = [&](double length_m, double curvature, double slope) {
    const Pose end = std::visit([](const auto& s) { return s.at(s.length_m()).pose; }, segments.back());
    segments.emplace_back(LinearCurvature(end, length_m, curvature, slope));
  };
  const double ramp_m = 1.5 * radius_m, peak = 1 / radius_m;
  append(ramp_m, 0, peak / ramp_m);
  append(ramp_m, peak, -peak / ramp_m);
  append(0.8, 0, 0);
  return Curve(std::move(segments));
}

/// Little friction: wheels that are slowed down return power.
ProfileRequest smooth_running(PowerSharing sharing, double efficiency) {
  Robot robot = testing::nomad();
  robot.motor.left.friction_torque_Nm = 0.02;
  robot.motor.right.friction_torque_Nm = 0.015;
  robot.power = {.standby_W = 5, .regeneration_efficiency = efficiency, .sharing = sharing};
  return {.piece = corner(0.3),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .time = {.mode = TimeMode::minimum_time},
          .nodes = 60,
          .accuracy = 1e-3,
          .solver = SolverChoice::fast};
}

double motion_J(const ProfileRequest& request, const Profile& profile) {
  return energy_by_cause(path_motion(request), profile).motion_J();
}

/// Energy (J) that one wheel returns while the other uses it, by sums over the profile in time.
double passed_on_J(const ProfileRequest& request, const Profile& profile) {
  const PathMotion motion = path_motion(request);
  constexpr int kSteps = 200000;
  const double h = profile.duration_s() / kSteps;
  double sum_J = 0;
  for (int k = 0; k < kSteps; ++k) {
    const ProfileState state = profile.at_time((k + 0.5) * h);
    const PathMotion::Place place = motion.place(state.s, state.time_s);
    const auto wheels = operating_point(
        request.plant, PathMotion::body_motion(place.rates, state.rate, state.acceleration), place.site);
    const double taken_W = std::max(wheels.left.power_W, wheels.right.power_W),
                 returned_W = -std::min(wheels.left.power_W, wheels.right.power_W);
    if (taken_W > 0 && returned_W > 0) sum_J += h * std::min(taken_W, returned_W);
  }
  return sum_J;
}

TEST(Regeneration, OnABusAWheelUsesThePowerThatTheOtherReturns) {
  const ProfileRequest any = smooth_running(PowerSharing::wheel, 0);
  const Profile profile = *solve_profile(any).profile;
  const double passed_J = passed_on_J(any, profile);
  ASSERT_GT(passed_J, 0.1) << "in this corner one wheel brakes while the other drives";
  for (double efficiency : {0.0, 0.6, 1.0}) {
    const double wheel_J = motion_J(smooth_running(PowerSharing::wheel, efficiency), profile),
                 bus_J = motion_J(smooth_running(PowerSharing::bus, efficiency), profile);
    EXPECT_NEAR(wheel_J - bus_J, (1 - efficiency) * passed_J, 1e-3 * passed_J) << efficiency;
  }
}

TEST(Regeneration, TheOptimumCostsLessTheMoreComesBackAndLeastOnABus) {
  const double T = 1.15 * solve_profile(smooth_running(PowerSharing::wheel, 0)).profile->duration_s();
  const auto planned = [&](PowerSharing sharing, double efficiency) {
    ProfileRequest request = smooth_running(sharing, efficiency);
    request.time = {.mode = TimeMode::fixed_time, .duration_s = T};
    const ProfileResult result = solve_profile(request);
    EXPECT_TRUE(result.profile && replay(request, *result.profile).valid()) << result.summary.message;
    return *result.profile;
  };
  const auto cost_J = [&](PowerSharing sharing, double efficiency, const Profile& profile) {
    return motion_J(smooth_running(sharing, efficiency), profile);
  };
  double before_J = kNoLimit;
  for (double efficiency : {0.0, 0.6, 1.0}) {
    const Profile for_wheel = planned(PowerSharing::wheel, efficiency),
                  for_bus = planned(PowerSharing::bus, efficiency);
    const double wheel_J = cost_J(PowerSharing::wheel, efficiency, for_wheel),
                 bus_J = cost_J(PowerSharing::bus, efficiency, for_bus);
    EXPECT_LT(wheel_J, before_J * (1 - 1e-3)) << efficiency;
    EXPECT_LE(bus_J, wheel_J * (1 + 1e-3)) << efficiency;
    // Each profile is the best under its own law, if the laws differ.
    const double margin = efficiency < 1 ? -5e-3 : 1e-3;
    EXPECT_LE(wheel_J, cost_J(PowerSharing::wheel, efficiency, for_bus) * (1 + margin)) << efficiency;
    EXPECT_LE(bus_J, cost_J(PowerSharing::bus, efficiency, for_wheel) * (1 + margin)) << efficiency;
    before_J = wheel_J;
  }
}

/// The Nomad's energy along a profile by the equations of [P1]: forces of the body's inertia, wheel torques,
/// currents, voltages; negative power of a wheel is lost. Midpoint sums in time.
struct Plain {
  double energy_J{};
  double slowest_wheel_rad_s{};  ///< most negative speed of the inner (left) wheel
};

Plain plain_energy(const PathPiece& piece, const Profile& profile) {
  constexpr double r = 0.1, l = 0.165, m = 21.2 + 2 * 1.39, wheel_inertia = 0.0281;
  constexpr double yaw_inertia = 0.5 + 2 * 1.39 * l * l + 2 * 0.007;
  constexpr double k = 0.069 * 24.9, resistance = 2.74, viscous = 0.0017;
  constexpr int kSteps = 400000;
  const double h = profile.duration_s() / kSteps;
  Plain sum;
  for (int i = 0; i < kSteps; ++i) {
    const ProfileState state = profile.at_time((i + 0.5) * h);
    const PathPoint point = piece_point(piece, state.s);
    const double v = state.rate, a = state.acceleration, yaw = point.curvature_per_m * v,
                 yaw_acceleration = point.curvature_per_m * a + point.curvature_slope_per_m2 * v * v;
    for (const double side : {-1.0, 1.0}) {  // left, right: a positive yaw rate speeds up the right wheel
      const double speed = (v + side * l * yaw) / r, acceleration = (a + side * l * yaw_acceleration) / r;
      const double force = m * a / 2 + side * yaw_inertia * yaw_acceleration / (2 * l);
      const double friction = side < 0 ? 0.3728 : 0.346;
      const double torque = r * force + wheel_inertia * acceleration + viscous * speed +
                            (speed == 0 ? 0.0 : std::copysign(friction, speed));
      const double current = torque / k;
      sum.energy_J += h * std::max(0.0, (resistance * current + k * speed) * current);
      if (side < 0) sum.slowest_wheel_rad_s = std::min(sum.slowest_wheel_rad_s, speed);
    }
  }
  return sum;
}

TEST(Reversal, InABendTighterThanHalfTheTrackTheInnerWheelTurnsBackwardAndIsPaidFor) {
  const Robot robot = testing::nomad();
  for (SolverChoice solver : {SolverChoice::fast, SolverChoice::ipopt}) {
    ProfileRequest request{.piece = corner(0.1),
                           .plant = make_plant(robot),
                           .limits = *robot.limits,
                           .time = {.mode = TimeMode::free_time},
                           .nodes = 150,
                           .solver = solver};
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile) << result.summary.message;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << again.limit << " " << again.worst_violation;
    const Plain plain = plain_energy(request.piece, *result.profile);
    EXPECT_LT(plain.slowest_wheel_rad_s, -0.1);
    EXPECT_NEAR(motion_J(request, *result.profile), plain.energy_J, 1e-4 * plain.energy_J);
    EXPECT_NEAR(again.motion_energy_J, plain.energy_J, 1e-4 * plain.energy_J);
  }
}

}  // namespace
}  // namespace joulepath
