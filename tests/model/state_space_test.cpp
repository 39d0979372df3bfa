#include "tests/support/state_space.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "model/power.hpp"
#include "tests/support/lagrange.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

using testing::FullCoordinates;
using testing::lagrange_torque_Nm;
using testing::lagrangian_J;
using testing::nomad;
using testing::rolling;
using testing::typical_effect;

/// A robot without symmetries that could hide a mistake: unequal radii, center of mass and payload off the
/// axle.
Robot bent_robot() {
  Robot robot = nomad();
  robot.geometry.wheel_radius_m = {0.097, 0.106};
  robot.geometry.center_of_mass_offset_m = 0.07;
  robot.payload_offset_m = -0.04;
  robot.motor.right.resistance_ohm = 2.5;
  robot.motor.left.viscous_friction_Nm_s_rad = 0.02;
  return robot;
}

struct Instant {
  StateVector state{};
  WheelVector acceleration_rad_s2{};
};

Instant random_instant(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Instant instant;
  for (int i = 0; i < 6; ++i) instant.state[i] = 5 * uniform(random);
  instant.acceleration_rad_s2 = {4 * uniform(random), 4 * uniform(random)};
  return instant;
}

TEST(StateSpace, VelocityMapObeysTheConstraints) {
  const Robot robot = bent_robot();
  for (double phi : {0.0, 0.4, 2.9, -1.3}) {
    const ConstraintMatrix A = constraint_matrix(robot.geometry, phi);
    EXPECT_LT((A * velocity_map(robot.geometry, phi)).norm(), 1e-15);
    const double h = 1e-6;
    const VelocityMap by_difference =
        (velocity_map(robot.geometry, phi + h) - velocity_map(robot.geometry, phi - h)) / (2 * h);
    EXPECT_LT((velocity_map_rate(robot.geometry, phi, 1.0) - by_difference).norm(), 1e-9);
  }
}

TEST(StateSpace, MassMatrixIsTheHessianOfAnIndependentKineticEnergy) {
  const Robot robot = bent_robot();
  const MassProperties mass = mass_properties(robot, 8.0);
  const double phi = 0.8;
  FullCoordinates q = FullCoordinates::Zero();
  q[2] = phi;
  const auto energy_J = [&](const Coordinates& rate) {  // phi' follows from the wheels, as in [P1, Eq. (12)]
    FullCoordinates full;
    full << rate[0], rate[1], rolling(robot.geometry, phi, rate.tail<2>())[2], rate[2], rate[3];
    return lagrangian_J(robot, 8.0, q, full);
  };
  Eigen::Matrix4d hessian;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const Coordinates a = Coordinates::Unit(i);
      const Coordinates b = Coordinates::Unit(j);
      hessian(i, j) = (energy_J(a + b) - energy_J(a - b)) / 2;
    }
  EXPECT_LT((mass_matrix(robot, mass, phi) - hessian).norm(), 1e-12);
}

TEST(StateSpace, ReducedMatricesAreTheProductsThatTheyStandFor) {
  const Robot robot = bent_robot();
  const MassProperties mass = mass_properties(robot, 5.7);
  const double phi = -0.6;
  const double yaw_rate = 1.7;
  const VelocityMap S = velocity_map(robot.geometry, phi);
  const Eigen::Matrix4d M = mass_matrix(robot, mass, phi);
  EXPECT_LT((S.transpose() * M * S - reduced_mass_matrix(robot, mass)).norm(), 1e-13);
  EXPECT_LT((S.transpose() * M * velocity_map_rate(robot.geometry, phi, yaw_rate) -
             reduced_coriolis_matrix(robot, mass, yaw_rate))
                .norm(),
            1e-13);
}

TEST(StateSpace, InertialTorquesFollowFromLagrangesEquations) {
  Robot robot = bent_robot();
  for (Side side : kSides) {
    robot.motor[side].friction_torque_Nm = 0;
    robot.motor[side].viscous_friction_Nm_s_rad = 0;
  }
  const Plant plant = make_plant(robot);
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Instant instant = random_instant(random);
    const DriveCircumstances circumstances{.payload_kg = 8.0, .heading_at_zero_rad = 0.3};
    const double phi = heading_rad(robot.geometry, 0.3, instant.state);
    const WheelVector expected =
        lagrange_torque_Nm(robot, 8.0, phi, instant.state.tail<2>(), instant.acceleration_rad_s2);
    const WheelVector voltage_V =
        voltages_for_V(plant, circumstances, instant.state, instant.acceleration_rad_s2);
    for (Side side : kSides) {
      const int k = wheel_index(side);
      const Motor& motor = robot.motor[side];
      const double current_A =
          (voltage_V[k] - motor.volts_per_speed_V_s_rad() * instant.state[4 + k]) / motor.resistance_ohm;
      EXPECT_NEAR(motor.torque_per_ampere_Nm_A() * current_A, expected[k],
                  1e-6 * (1 + std::abs(expected[k])));
    }
  }
}

TEST(StateSpace, IsThePapersMatrixEquation) {
  const Plant plant = make_plant(bent_robot());
  std::mt19937 random(4);
  for (int i = 0; i < 20; ++i) {
    const Instant instant = random_instant(random);
    const DriveCircumstances circumstances{.payload_kg = 2.0, .heading_at_zero_rad = -1.0};
    const WheelVector V{3.0, -2.0};
    const WheelVector eta = instant.state.tail<2>();
    const double phi = heading_rad(plant.robot.geometry, -1.0, instant.state);
    const double yaw_rate = rolling(plant.robot.geometry, phi, eta)[2];
    const VelocityMap S = velocity_map(plant.robot.geometry, phi);
    const Eigen::Matrix4d M = mass_matrix(plant.robot, mass_properties(plant.robot, 2.0), phi);
    const WheelVector by_eq_23 =
        (S.transpose() * M * S).inverse() *
        (S.transpose() * (voltage_matrix(plant, 0) * V - load_vector(plant, circumstances, instant.state) -
                          damping_matrix(plant, 0) * S * eta -
                          M * velocity_map_rate(plant.robot.geometry, phi, yaw_rate) * eta));
    const StateVector by_eq_25 =
        drift(plant, circumstances, instant.state) + input_matrix(plant, circumstances) * V;
    const StateVector rate = state_derivative(plant, circumstances, instant.state, V);
    EXPECT_LT((rate.tail<2>() - by_eq_23).norm(), 1e-10);
    EXPECT_LT((rate - by_eq_25).norm(), 1e-10);
    EXPECT_LT((rate.head<4>() - S * eta).norm(), 1e-12);
  }
}

TEST(StateSpace, VoltagesGiveTheMotionBackForEveryEffectInTheCatalog) {
  std::mt19937 random(5);
  for (const EffectDescription& description : effect_catalog()) {
    const Plant plant = make_plant(bent_robot(), {typical_effect(description)});
    for (int i = 0; i < 20; ++i) {
      const Instant instant = random_instant(random);
      const DriveCircumstances circumstances{.payload_kg = 5.7, .time_of_day_s = 300, .memory = {0.2, -0.1}};
      const WheelVector V = voltages_for_V(plant, circumstances, instant.state, instant.acceleration_rad_s2);
      const StateVector rate = state_derivative(plant, circumstances, instant.state, V);
      EXPECT_LT((rate.tail<2>() - instant.acceleration_rad_s2).norm(), 1e-10) << description.info.name;
    }
  }
}

TEST(StateSpace, AgreesWithTheOperatingPointForEveryRigidEffect) {
  std::mt19937 random(6);
  for (const EffectDescription& description : effect_catalog()) {
    if (description.info.stage == Stage::contact) continue;  // creep is not rigid rolling
    const Plant plant = make_plant(bent_robot(), {typical_effect(description)});
    const Geometry& geometry = plant.robot.geometry;
    for (int i = 0; i < 20; ++i) {
      const Instant instant = random_instant(random);
      const DriveCircumstances circumstances{.payload_kg = 5.7, .heading_at_zero_rad = 0.1};
      const Twist<double> twist = body_twist(geometry, Sided<double>{instant.state[4], instant.state[5]});
      const Twist<double> rate =
          body_twist(geometry, Sided<double>{instant.acceleration_rad_s2[0], instant.acceleration_rad_s2[1]});
      const Pose pose{instant.state[0], instant.state[1], heading_rad(geometry, 0.1, instant.state)};
      const Site site = site_of(geometry, pose, 5.7, twist.speed_m_s, twist.yaw_rate_rad_s);
      const auto wheels = operating_point(
          plant,
          BodyMotion<double>{twist.speed_m_s, rate.speed_m_s, twist.yaw_rate_rad_s, rate.yaw_rate_rad_s},
          site);
      const WheelVector V = voltages_for_V(plant, circumstances, instant.state, instant.acceleration_rad_s2);
      EXPECT_NEAR(V[0], wheels.left.voltage_V, 1e-10) << description.info.name;
      EXPECT_NEAR(V[1], wheels.right.voltage_V, 1e-10) << description.info.name;
    }
  }
}

TEST(StateSpace, EnergyInIsCopperFrictionAndKineticChange) {
  const Plant plant = make_plant(bent_robot());
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    const Instant instant = random_instant(random);
    const DriveCircumstances circumstances{.payload_kg = 8.0};
    const StateVector& x = instant.state;
    const WheelVector V = voltages_for_V(plant, circumstances, x, instant.acceleration_rad_s2);
    const auto kinetic_J = [&](double t) {
      const WheelVector eta = x.tail<2>() + t * instant.acceleration_rad_s2;
      const double phi =
          heading_rad(plant.robot.geometry, 0, x) + t * rolling(plant.robot.geometry, 0, x.tail<2>())[2];
      FullCoordinates q = FullCoordinates::Zero();
      q[2] = phi;
      return lagrangian_J(plant.robot, 8.0, q, rolling(plant.robot.geometry, phi, eta));
    };
    double balance_W = -(kinetic_J(1e-5) - kinetic_J(-1e-5)) / 2e-5;
    for (Side side : kSides) {
      const Motor& motor = plant.robot.motor[side];
      const double speed = x[4 + wheel_index(side)];
      const double current_A =
          (V[wheel_index(side)] - motor.volts_per_speed_V_s_rad() * speed) / motor.resistance_ohm;
      balance_W += V[wheel_index(side)] * current_A - motor.resistance_ohm * current_A * current_A -
                   motor.friction_torque_Nm * std::abs(speed) -
                   motor.viscous_friction_Nm_s_rad * speed * speed;
    }
    EXPECT_NEAR(balance_W, 0.0, 1e-6);
  }
}

TEST(StateSpace, MirroredRobotTurnsTheOtherWay) {
  const Robot robot = bent_robot();
  Robot mirrored = robot;
  std::swap(mirrored.motor.left, mirrored.motor.right);
  std::swap(mirrored.geometry.wheel_radius_m.left, mirrored.geometry.wheel_radius_m.right);
  std::mt19937 random(9);
  for (int i = 0; i < 20; ++i) {
    const StateVector x = random_instant(random).state;
    StateVector reflected;
    reflected << x[0], -x[1], x[3], x[2], x[5], x[4];
    const StateVector a = state_derivative(make_plant(robot), {.payload_kg = 3}, x, {4.0, 1.5});
    const StateVector b = state_derivative(make_plant(mirrored), {.payload_kg = 3}, reflected, {1.5, 4.0});
    StateVector expected;
    expected << a[0], -a[1], a[3], a[2], a[5], a[4];
    EXPECT_LT((b - expected).norm(), 1e-12);
  }
}

TEST(StateSpace, AForwardCenterOfMassPullsTheTurnStraight) {
  // With mu > 0 and v > 0 a turn needs a moment of mu v omega, and holding v needs less force by mu omega^2.
  Robot robot = nomad();
  const WheelVector eta{3.0, 5.0};
  StateVector x = StateVector::Zero();
  x.tail<2>() = eta;
  const auto torque_Nm = [&](double d) {
    robot.geometry.center_of_mass_offset_m = d;
    const Plant plant = make_plant(robot);
    const WheelVector V = voltages_for_V(plant, {}, x, WheelVector::Zero());
    const Motor& motor = robot.motor.left;
    return WheelVector((V - motor.volts_per_speed_V_s_rad() * eta) / motor.resistance_ohm *
                       motor.torque_per_ampere_Nm_A());
  };
  const WheelVector extra = torque_Nm(0.1) - torque_Nm(0.0);
  const double mu = 21.2 * 0.1;
  const double omega = 0.1 * 2.0 / 0.33;
  const double from_force = 0.1 / 2 * (-mu * omega * omega);
  const double from_moment = 0.1 / (2 * 0.165) * mu * 0.4 * omega;
  EXPECT_NEAR(extra[0], from_force - from_moment, 1e-12);
  EXPECT_NEAR(extra[1], from_force + from_moment, 1e-12);
}

}  // namespace
}  // namespace joulepath
