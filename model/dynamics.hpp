#pragma once

#include "model/motion.hpp"

namespace joulepath {

/// Inertia of the whole robot with its payload, about the axle midpoint P0.
struct MassProperties {
  double mass_kg{};            ///< m = m_c + 2 m_w + m_p
  double first_moment_kg_m{};  ///< mu = m_c d + m_p d_p, forward of P0
  double yaw_inertia_kg_m2{};  ///< I about P0, wheels included, without their spin about the axle
};

/// Chassis, wheels and payload together; both yaw inertias are about the respective mass center.
///
///   I = I_c + k m_p + m_c d^2 + m_p d_p^2 + 2 m_w l^2 + 2 I_m    [P1, Eq. (12)], with Steiner's terms
inline MassProperties mass_properties(const Robot& robot, double payload_kg) {
  const double d = robot.geometry.center_of_mass_offset_m;
  const double d_p = robot.payload_offset_or_default_m();
  const double l = robot.geometry.half_track_m;
  const Inertia& inertia = robot.inertia;
  const double chassis_kg = inertia.chassis_mass_kg;
  return {.mass_kg = robot.total_mass_kg(payload_kg),
          .first_moment_kg_m = chassis_kg * d + payload_kg * d_p,
          .yaw_inertia_kg_m2 = inertia.chassis_yaw_inertia_kg_m2 +
                               inertia.payload_yaw_inertia_m2 * payload_kg + chassis_kg * d * d +
                               payload_kg * d_p * d_p + 2 * inertia.wheel_mass_kg * l * l +
                               2 * inertia.wheel_diameter_inertia_kg_m2};
}

/// Force along the heading and moment about P0 that both wheels together must apply.
template <class Real>
struct Wrench {
  Real force_N{};
  Real moment_Nm{};
};

/// Wrench that accelerates the robot, with mu forward of P0: the equations of motion of [P1, Eqs. (13)-(23)],
/// projected on the motions that the wheels allow (SᵀMS, SᵀM S_dot), in body coordinates:
///
///   F = m v' - mu omega^2,     M = I omega' + mu v omega
template <class Real>
Wrench<Real> inertial_wrench(const MassProperties& mass, const BodyMotion<Real>& motion) {
  const Real& omega = motion.yaw_rate_rad_s;
  return {mass.mass_kg * motion.acceleration_m_s2 - mass.first_moment_kg_m * omega * omega,
          mass.yaw_inertia_kg_m2 * motion.yaw_acceleration_rad_s2 +
              mass.first_moment_kg_m * motion.speed_m_s * omega};
}

/// Contact forces (N, along the heading) of the two wheels that make up a wrench:
///   f = F/2 +/- M/(2 l), + for the right wheel.
template <class Real>
Sided<Real> contact_forces_N(double half_track_m, const Wrench<Real>& wrench) {
  const Real from_moment_N = wrench.moment_Nm / (2.0 * half_track_m);
  return {wrench.force_N / 2.0 - from_moment_N, wrench.force_N / 2.0 + from_moment_N};
}

/// Kinetic energy (J) of the robot, spin of the wheels included.                [P1, Eq. (12)]
inline double kinetic_energy_J(const Robot& robot, const MassProperties& mass, double speed_m_s,
                               double yaw_rate_rad_s, const Sided<double>& wheel_speed_rad_s) {
  const double spin =
      wheel_speed_rad_s.left * wheel_speed_rad_s.left + wheel_speed_rad_s.right * wheel_speed_rad_s.right;
  return 0.5 *
         (mass.mass_kg * speed_m_s * speed_m_s + mass.yaw_inertia_kg_m2 * yaw_rate_rad_s * yaw_rate_rad_s +
          robot.inertia.wheel_axle_inertia_kg_m2 * spin);
}

}  // namespace joulepath
