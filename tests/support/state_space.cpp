#include "tests/support/state_space.hpp"

#include <Eigen/LU>
#include <cmath>

#include "model/operating_point.hpp"

namespace joulepath {
namespace {

/// (c_left, c_right) with phi' = c_left q_left' + c_right q_right'.
WheelVector yaw_per_wheel(const Geometry& geometry) {
  const double twice_l_m = 2 * geometry.half_track_m;
  return {-geometry.wheel_radius_m.left / twice_l_m, geometry.wheel_radius_m.right / twice_l_m};
}

WheelVector speed_per_wheel_m(const Geometry& geometry) {
  return {geometry.wheel_radius_m.left / 2, geometry.wheel_radius_m.right / 2};
}

MassProperties mass_of(const Plant& plant, const DriveCircumstances& circumstances) {
  return mass_properties(plant.robot, plant.payload_kg(circumstances.payload_kg));
}

Twist<double> twist_of(const Plant& plant, const StateVector& state) {
  return body_twist(plant.robot.geometry, Sided<double>{state[4], state[5]});
}

Site site_at(const Plant& plant, const DriveCircumstances& circumstances, const StateVector& state) {
  const Geometry& geometry = plant.robot.geometry;
  const Twist<double> twist = twist_of(plant, state);
  const Pose pose{state[0], state[1], heading_rad(geometry, circumstances.heading_at_zero_rad, state)};
  Site site = site_of(geometry, pose, circumstances.payload_kg, twist.speed_m_s, twist.yaw_rate_rad_s,
                      circumstances.time_of_day_s);
  site.wheel_direction = {sign_of(state[4]), sign_of(state[5])};
  site.memory = circumstances.memory;
  return site;
}

/// Torques that the wheels need besides inertia in (SᵀMS) eta': SᵀC + nu eta + SᵀM S_dot eta.
WheelVector resisting_torque_Nm(const Plant& plant, const DriveCircumstances& circumstances,
                                const StateVector& state) {
  const MassProperties mass = mass_of(plant, circumstances);
  const double yaw_rate_rad_s = twist_of(plant, state).yaw_rate_rad_s;
  const double phi = heading_rad(plant.robot.geometry, circumstances.heading_at_zero_rad, state);
  const WheelVector eta = state.tail<2>();
  const WheelVector viscous_Nm{plant.robot.motor.left.viscous_friction_Nm_s_rad * eta[0],
                               plant.robot.motor.right.viscous_friction_Nm_s_rad * eta[1]};
  const VelocityMap S = velocity_map(plant.robot.geometry, phi);
  return S.transpose() * load_vector(plant, circumstances, state) + viscous_Nm +
         reduced_coriolis_matrix(plant.robot, mass, yaw_rate_rad_s) * eta;
}

/// Current (A) for a commanded voltage, after the driver's voltage drop.   [P1, Eq. (15)]
double current_from_voltage_A(const Plant& plant, const Motor& motor, double hot, double voltage_V,
                              double wheel_speed_rad_s) {
  const double across_V = voltage_V - motor.volts_per_speed_V_s_rad() * wheel_speed_rad_s;
  const double size_V = std::max(0.0, std::abs(across_V) - plant.driver_voltage_drop_V);
  return sign_of(across_V) * size_V / (hot * motor.resistance_ohm);
}

}  // namespace

double heading_rad(const Geometry& geometry, double heading_at_zero_rad, const StateVector& state) {
  return heading_at_zero_rad + yaw_per_wheel(geometry).dot(state.segment<2>(2));
}

ConstraintMatrix constraint_matrix(const Geometry& geometry, double heading_rad) {
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  const WheelVector v = speed_per_wheel_m(geometry);
  ConstraintMatrix A;
  A << s, -c, 0, 0,  //
      c, s, -v[0], -v[1];
  return A;
}

VelocityMap velocity_map(const Geometry& geometry, double heading_rad) {
  const WheelVector v = speed_per_wheel_m(geometry);
  VelocityMap S;
  S.row(0) = std::cos(heading_rad) * v.transpose();
  S.row(1) = std::sin(heading_rad) * v.transpose();
  S.bottomRows<2>().setIdentity();
  return S;
}

VelocityMap velocity_map_rate(const Geometry& geometry, double heading_rad, double yaw_rate_rad_s) {
  const WheelVector v = speed_per_wheel_m(geometry);
  VelocityMap S_dot;
  S_dot.row(0) = -yaw_rate_rad_s * std::sin(heading_rad) * v.transpose();
  S_dot.row(1) = yaw_rate_rad_s * std::cos(heading_rad) * v.transpose();
  S_dot.bottomRows<2>().setZero();
  return S_dot;
}

Eigen::Matrix4d mass_matrix(const Robot& robot, const MassProperties& mass, double heading_rad) {
  const WheelVector c = yaw_per_wheel(robot.geometry);
  const double mu = mass.first_moment_kg_m;
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  M.diagonal() << mass.mass_kg, mass.mass_kg, robot.inertia.wheel_axle_inertia_kg_m2,
      robot.inertia.wheel_axle_inertia_kg_m2;
  M.bottomRightCorner<2, 2>() += mass.yaw_inertia_kg_m2 * c * c.transpose();
  M.block<1, 2>(0, 2) = -mu * std::sin(heading_rad) * c.transpose();
  M.block<1, 2>(1, 2) = mu * std::cos(heading_rad) * c.transpose();
  M.bottomLeftCorner<2, 2>() = M.topRightCorner<2, 2>().transpose().eval();
  return M;
}

Eigen::Matrix4d damping_matrix(const Plant& plant, double time_of_day_s) {
  const double hot = plant.resistance_factor(time_of_day_s);
  Eigen::Matrix4d F = Eigen::Matrix4d::Zero();
  for (Side side : kSides) {
    const Motor& motor = plant.robot.motor[side];
    const int k = 2 + wheel_index(side);
    F(k, k) =
        motor.torque_per_ampere_Nm_A() * motor.volts_per_speed_V_s_rad() / (hot * motor.resistance_ohm) +
        motor.viscous_friction_Nm_s_rad;
  }
  return F;
}

VelocityMap voltage_matrix(const Plant& plant, double time_of_day_s) {
  const double hot = plant.resistance_factor(time_of_day_s);
  VelocityMap T = VelocityMap::Zero();
  for (Side side : kSides) {
    const Motor& motor = plant.robot.motor[side];
    T(2 + wheel_index(side), wheel_index(side)) =
        motor.torque_per_ampere_Nm_A() / (hot * motor.resistance_ohm);
  }
  return T;
}

Coordinates load_vector(const Plant& plant, const DriveCircumstances& circumstances,
                        const StateVector& state) {
  const MassProperties mass = mass_of(plant, circumstances);
  const Site site = site_at(plant, circumstances, state);
  const Twist<double> twist = twist_of(plant, state);
  const BodyLoad<double> load = effect_load(plant, mass, twist.speed_m_s, twist.yaw_rate_rad_s, site);
  const WheelVector c = yaw_per_wheel(plant.robot.geometry);
  const double along_N = load.force_N - mass.first_moment_kg_m * twist.yaw_rate_rad_s * twist.yaw_rate_rad_s;
  Coordinates C;
  C << along_N * std::cos(site.pose.heading_rad), along_N * std::sin(site.pose.heading_rad), 0, 0;
  for (Side side : kSides) {
    const int k = wheel_index(side);
    const double speed_rad_s = state[4 + k];
    C[2 + k] = c[k] * load.moment_Nm + shaft_friction_Nm(plant, mass, side, speed_rad_s, site) -
               plant.robot.motor[side].viscous_friction_Nm_s_rad * speed_rad_s;
  }
  return C;
}

Eigen::Matrix2d reduced_mass_matrix(const Robot& robot, const MassProperties& mass) {
  const WheelVector v = speed_per_wheel_m(robot.geometry);
  const WheelVector c = yaw_per_wheel(robot.geometry);
  return mass.mass_kg * v * v.transpose() + mass.yaw_inertia_kg_m2 * c * c.transpose() +
         robot.inertia.wheel_axle_inertia_kg_m2 * Eigen::Matrix2d::Identity();
}

Eigen::Matrix2d reduced_coriolis_matrix(const Robot& robot, const MassProperties& mass,
                                        double yaw_rate_rad_s) {
  const WheelVector v = speed_per_wheel_m(robot.geometry);
  const WheelVector c = yaw_per_wheel(robot.geometry);
  return mass.first_moment_kg_m * yaw_rate_rad_s * c * v.transpose();
}

StateVector state_derivative(const Plant& plant, const DriveCircumstances& circumstances,
                             const StateVector& state, const WheelVector& voltage_V) {
  const double hot = plant.resistance_factor(circumstances.time_of_day_s);
  WheelVector torque_Nm = -resisting_torque_Nm(plant, circumstances, state);
  for (Side side : kSides) {
    const int k = wheel_index(side);
    const Motor& motor = plant.robot.motor[side];
    const double motor_Nm = motor.torque_per_ampere_Nm_A() *
                            current_from_voltage_A(plant, motor, hot, voltage_V[k], state[4 + k]);
    torque_Nm[k] += motor_Nm - plant.torque_loss_fraction * std::abs(motor_Nm) * sign_of(state[4 + k]);
  }
  const double phi = heading_rad(plant.robot.geometry, circumstances.heading_at_zero_rad, state);
  StateVector derivative;
  derivative.head<4>() = velocity_map(plant.robot.geometry, phi) * state.tail<2>();
  derivative.tail<2>() =
      reduced_mass_matrix(plant.robot, mass_of(plant, circumstances)).inverse() * torque_Nm;
  return derivative;
}

StateVector drift(const Plant& plant, const DriveCircumstances& circumstances, const StateVector& state) {
  return state_derivative(plant, circumstances, state, WheelVector::Zero());
}

Eigen::Matrix<double, 6, 2> input_matrix(const Plant& plant, const DriveCircumstances& circumstances) {
  Eigen::Matrix<double, 6, 2> g = Eigen::Matrix<double, 6, 2>::Zero();
  g.bottomRows<2>() = reduced_mass_matrix(plant.robot, mass_of(plant, circumstances)).inverse() *
                      voltage_matrix(plant, circumstances.time_of_day_s).bottomRows<2>();
  return g;
}

WheelVector voltages_for_V(const Plant& plant, const DriveCircumstances& circumstances,
                           const StateVector& state, const WheelVector& wheel_acceleration_rad_s2) {
  const double hot = plant.resistance_factor(circumstances.time_of_day_s);
  const WheelVector load_Nm =
      reduced_mass_matrix(plant.robot, mass_of(plant, circumstances)) * wheel_acceleration_rad_s2 +
      resisting_torque_Nm(plant, circumstances, state);
  WheelVector voltage_V;
  for (Side side : kSides) {
    const int k = wheel_index(side);
    const Motor& motor = plant.robot.motor[side];
    const double torque_Nm =
        torque_before_gear_Nm(load_Nm[k], plant.torque_loss_fraction, sign_of(state[4 + k]));
    const double current_A = motor_current_A(motor, torque_Nm);
    voltage_V[k] = hot * motor.resistance_ohm * current_A + motor.volts_per_speed_V_s_rad() * state[4 + k] +
                   plant.driver_voltage_drop_V * sign_of(current_A);
  }
  return voltage_V;
}

}  // namespace joulepath
