// Right-hand side of the simulated drive at single instants.
#include "model/simulation/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/simulation/integrator.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Yaw acceleration on a straight line that casters aligned with this course cause.
double yaw_from_casters(double speed_m_s, double caster_course) {
  const EffectSetting casters{.name = "caster_swivel", .parameters = {{"moment_Nm", 2.0}, {"trail_m", 0.1}}};
  const Drive drive(make_plant(testing::nomad(), {casters}));
  const auto yaw_acceleration = [&](double memory) {
    DriveState state{};
    state[kVelocity + kTravel] = speed_m_s;
    for (Side side : kSides)
      state[kVelocity + surface_of(side)] = speed_m_s / testing::nomad().geometry.wheel_radius_m[side];
    for (std::size_t k = 0; k < kMaxMemories; ++k) state[kMemory + k] = memory;
    return drive.evaluate(state, 0.0, {1, 1, 1, 1}).derivative[kVelocity + kTurn];
  };
  return yaw_acceleration(caster_course) - yaw_acceleration(0.0);
}

/// Casters push in proportion to their angle; below 1 mm/s the robot counts as standing and they fade, with
/// half of the push at 1 mm/s.
TEST(Drive, CastersPushWhileTheRobotMoves) {
  const double moving = yaw_from_casters(0.5, 1.0);
  EXPECT_GT(std::abs(moving), 0.1);
  EXPECT_NEAR(yaw_from_casters(0.5, -0.5), -0.5 * moving, 1e-9);
  EXPECT_NEAR(yaw_from_casters(1e-3, 1.0), 0.5 * moving, 1e-5 * std::abs(moving));
  EXPECT_NEAR(yaw_from_casters(1e-6, 1.0), 0.0, 1e-5 * std::abs(moving));
}

/// At a heading of 30 degrees, 2 m ahead and 1 m to the left.
TEST(DriveIntegrator, DisplacesTheRobotInItsOwnDirections) {
  DriveState start{};
  start[kYaw] = std::numbers::pi / 6;
  DriveIntegrator integrator(Drive(make_plant(testing::nomad())), start, {});
  integrator.displace(2.0, 1.0);
  EXPECT_NEAR(integrator.state()[kX], std::sqrt(3.0) - 0.5, 1e-12);
  EXPECT_NEAR(integrator.state()[kY], 1.0 + std::sqrt(3.0) / 2, 1e-12);
}

}  // namespace
}  // namespace joulepath
