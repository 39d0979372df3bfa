#include <gtest/gtest.h>

#include "model/energy.hpp"
#include "model/operating_point.hpp"
#include "model/power.hpp"
#include "model/simulation/drive.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

EnergyByCause account(double scale) {
  EnergyByCause energy;
  energy.copper_J = 1 * scale;
  energy.coulomb_friction_J = 10 * scale;
  energy.viscous_friction_J = 100 * scale;
  energy.kinetic_J = 1e3 * scale;
  energy.not_recovered_J = 1e4 * scale;
  energy.standby_J = 1e5 * scale;
  energy.effects_J = {{"rolling_resistance", 1e6 * scale}};
  return energy;
}

TEST(EnergyByCause, ASumHasEveryCauseOfBoth) {
  EnergyByCause sum = account(1);
  sum += account(2);
  sum.effects_J["floor_slope"] = 0;
  EXPECT_EQ(sum.copper_J, 3);
  EXPECT_EQ(sum.coulomb_friction_J, 30);
  EXPECT_EQ(sum.viscous_friction_J, 300);
  EXPECT_EQ(sum.kinetic_J, 3e3);
  EXPECT_EQ(sum.not_recovered_J, 3e4);
  EXPECT_EQ(sum.standby_J, 3e5);
  EXPECT_EQ(sum.effects_J.at("rolling_resistance"), 3e6);
}

TEST(EnergyByCause, MotionIsEveryCauseButStandby) {
  EXPECT_EQ(account(1).motion_J(), 1011111);
  EXPECT_EQ(account(1).total_J(), 1111111);
}

TEST(EnergyByCause, PowerOverATimeIsAddedToEveryCause) {
  const PowerByCause watts{.copper_W = 1,
                           .coulomb_friction_W = 10,
                           .viscous_friction_W = 100,
                           .kinetic_W = 1e3,
                           .not_recovered_W = 1e4,
                           .standby_W = 1e5};
  EnergyByCause energy = account(1);
  energy.add(Plant{}, watts, 2.0);
  EXPECT_EQ(energy.motion_J(), 1011111 + 2 * 11111);
  EXPECT_EQ(energy.total_J(), 1111111 + 2 * 111111);
}

/// A turn about the left wheel: direction 0 has no friction, neither in the power nor in the torque.
TEST(PowerByCause, AWheelThatStandsHasNoFriction) {
  const Robot robot = testing::nomad();
  const Plant plant = make_plant(robot);
  const double omega = 0.5, v = omega * robot.geometry.half_track_m;
  const BodyMotion<double> motion{v, 0.0, omega, 0.0};
  const Site site = site_of(robot.geometry, {}, 0.0, v, omega);
  ASSERT_EQ(site.wheel_direction.left, 0);
  ASSERT_EQ(site.wheel_direction.right, 1);
  const Sided<WheelState<double>> wheels = operating_point(plant, motion, site);
  const PowerByCause watts = power_by_cause(plant, motion, site);
  EXPECT_NEAR(watts.coulomb_friction_W,
              robot.motor.right.friction_torque_Nm * 2 * v / robot.geometry.wheel_radius_m.right, 1e-12);
  EXPECT_NEAR(watts.motor_W(), wheels.left.power_W + wheels.right.power_W, 1e-9);
}

TEST(Drive, CurrentStoresHalfInductanceTimesItsSquareInEachWinding) {
  Robot robot = testing::nomad();
  robot.motor.left.inductance_H = 0.002, robot.motor.right.inductance_H = 0.005;
  const Drive drive(make_plant(robot));
  DriveState state{};
  EXPECT_EQ(drive.stored_energy_J(state), 0.0);
  state[kArmatureLeft] = 3, state[kArmatureRight] = -4;
  EXPECT_NEAR(drive.stored_energy_J(state), 0.5 * 0.002 * 9 + 0.5 * 0.005 * 16, 1e-15);
}

}  // namespace
}  // namespace joulepath
