#pragma once

#include <cmath>
#include <type_traits>

#include "model/kinematics.hpp"
#include "model/motor.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// One wheel at an instant. The voltage is what the driver is commanded to put out.
template <class Real>
struct WheelState {
  Real speed_rad_s{};
  Real contact_force_N{};  ///< along the heading, on the robot
  Real torque_Nm{};  ///< Kt n i: the total torque of the motor at the wheel, friction and gear loss included
  Real current_A{};
  Real voltage_V{};
  Real power_W{};  ///< V i at the driver's output, negative where the drive returns power
};

/// How kinks of loads are rounded for automatic differentiation: |x| becomes sqrt(x^2 + width^2), in Nm or A.
/// A solver may begin with a large width and narrow it. Its second derivative then takes the slope of |x|
/// from the width before:  (1 - x^2/(size size_before))/size.  It is exact where both widths are equal.
/// Otherwise a Newton step follows a load that stays within its kink while the kink becomes narrower. [T.
/// Chan, G. Golub, P. Mulet: A nonlinear primal-dual method for total variation-based image restoration, SIAM
/// J. Sci. Comput. 20 (1999)]
struct KinkRounding {
  double width{0.01};
  double width_before{0.01};
};

/// |x|: exact for numbers, rounded for automatic differentiation.
template <class Real>
Real magnitude(const Real& x, const KinkRounding& rounding) {
  if constexpr (std::is_same_v<Real, double>) {
    return std::abs(x);
  } else {
    const double size = std::hypot(x.value, rounding.width);
    const double before = std::hypot(x.value, rounding.width_before);
    return x.through(size, x.value / size, (1 - x.value * x.value / (size * before)) / size);
  }
}

/// The sign of x: exact for numbers, for automatic differentiation x/size with its exact derivatives.
template <class Real>
Real direction_of(const Real& x, const KinkRounding& rounding) {
  if constexpr (std::is_same_v<Real, double>) {
    return sign_of(x);
  } else {
    const double size = std::hypot(x.value, rounding.width), square = rounding.width * rounding.width;
    const double slope = square / (size * size * size);
    return x.through(x.value / size, slope, -3 * x.value * slope / (size * size));
  }
}

/// Motor torque that leaves `load` after a gear that loses a fraction of what it transmits:
///   x = load + loss |x| direction  =  (load + loss |load| direction)/(1 - loss^2)
template <class Real>
Real torque_before_gear_Nm(const Real& load_Nm, double loss_fraction, double direction,
                           const KinkRounding& rounding = {}) {
  const double loss = loss_fraction * direction;
  if (loss == 0.0) return load_Nm;
  return (load_Nm + loss * magnitude(load_Nm, rounding)) / (1.0 - loss * loss);
}

/// Sum of the body loads of all effects.
template <class Real>
BodyLoad<Real> effect_load(const Plant& plant, const MassProperties& mass, const Real& speed_m_s,
                           const Real& yaw_rate_rad_s, const Site& site) {
  BodyLoad<Real> sum{Real(0.0), Real(0.0)};
  for_each_effect(plant, site.memory, [&](std::size_t, const auto& effect, double memory) {
    const BodyContext<Real> body{plant.robot, site,           mass.mass_kg, mass.first_moment_kg_m,
                                 speed_m_s,   yaw_rate_rad_s, memory};
    if constexpr (requires { effect.body_load(body); }) {
      const BodyLoad<Real> load = effect.body_load(body);
      sum.force_N += load.force_N;
      sum.moment_Nm += load.moment_Nm;
    }
  });
  return sum;
}

/// Torque that resists one wheel at its shaft: viscous and Coulomb friction, and the effects'.
///   nu q' + T_m sign(q') + effects                                  [P1, Eqs. (14), (17)]
template <class Real>
Real shaft_friction_Nm(const Plant& plant, const MassProperties& mass, Side side,
                       const Real& wheel_speed_rad_s, const Site& site) {
  const Motor& motor = plant.robot.motor[side];
  const WheelContext<Real> wheel{.site = site,
                                 .side = side,
                                 .speed_rad_s = wheel_speed_rad_s,
                                 .direction = site.wheel_direction[side],
                                 .radius_m = plant.robot.geometry.wheel_radius_m[side],
                                 .normal_load_N = 0.5 * mass.mass_kg * kGravity_m_s2};
  Real torque_Nm =
      motor.viscous_friction_Nm_s_rad * wheel_speed_rad_s + motor.friction_torque_Nm * wheel.direction;
  for (const Effect& effect : plant.effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.shaft_torque_Nm(wheel); }) torque_Nm += e.shaft_torque_Nm(wheel);
        },
        effect);
  return torque_Nm;
}

/// State of both wheels and motors for a motion of the body: the power model of planning, estimation and
/// diagnosis.
///
///   f = F/2 +/- M/(2 l);   tau = r f + (I_w + I_s) q'' + nu q' + T_m sign(q') + effects;
///   i = tau/(Kt n);   V = R i + Kv n q';   P = V i          [P1, Eqs. (19)-(28)], docs/equations.md
///
/// With creep at the contact, r q' exceeds the contact point's speed by f/stiffness.
template <class Real>
Sided<WheelState<Real>> operating_point(const Plant& plant, const BodyMotion<Real>& motion, const Site& site,
                                        const KinkRounding& rounding = {}) {
  const Robot& robot = plant.robot;
  const MassProperties mass = mass_properties(robot, plant.payload_kg(site.payload_kg));
  const BodyLoad<Real> load = effect_load(plant, mass, motion.speed_m_s, motion.yaw_rate_rad_s, site);
  Wrench<Real> wrench = inertial_wrench(mass, motion);
  wrench.force_N += load.force_N;
  wrench.moment_Nm += load.moment_Nm;
  const Sided<Real> force_N = contact_forces_N(robot.geometry.half_track_m, wrench);
  const Sided<Real> speed = wheel_speeds_rad_s(robot.geometry, motion.speed_m_s, motion.yaw_rate_rad_s);
  const Sided<Real> acceleration =
      wheel_speeds_rad_s(robot.geometry, motion.acceleration_m_s2, motion.yaw_acceleration_rad_s2);
  const double resistance_factor = plant.resistance_factor(site.time_of_day_s);

  Sided<WheelState<Real>> wheels;
  for (Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const double radius_m = robot.geometry.wheel_radius_m[side];
    const double direction = site.wheel_direction[side];
    WheelState<Real>& wheel = wheels[side];
    wheel.contact_force_N = force_N[side];
    wheel.speed_rad_s = speed[side] + (plant.creep_m_s_N / radius_m) * force_N[side];
    const Real load_Nm = radius_m * force_N[side] +
                         robot.inertia.wheel_axle_inertia_kg_m2 * acceleration[side] +
                         shaft_friction_Nm(plant, mass, side, wheel.speed_rad_s, site);
    wheel.torque_Nm = torque_before_gear_Nm(load_Nm, plant.torque_loss_fraction, direction, rounding);
    wheel.current_A = motor_current_A(motor, wheel.torque_Nm);
    wheel.voltage_V = resistance_factor * motor.resistance_ohm * wheel.current_A +
                      motor.volts_per_speed_V_s_rad() * wheel.speed_rad_s;
    const double drop_V = plant.driver_voltage_drop_V;
    if constexpr (!std::is_same_v<Real, double>)
      wheel.power_W = wheel.voltage_V * wheel.current_A + drop_V * magnitude(wheel.current_A, rounding);
    if (drop_V != 0.0) wheel.voltage_V += drop_V * direction_of(wheel.current_A, rounding);
    if constexpr (std::is_same_v<Real, double>) wheel.power_W = wheel.voltage_V * wheel.current_A;
  }
  return wheels;
}

}  // namespace joulepath
