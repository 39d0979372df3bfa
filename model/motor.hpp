#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// Armature current (A) that gives a torque at the wheel: i = tau/(Kt n).      [P1, Eq. (14)]
template <class Real>
Real motor_current_A(const Motor& motor, const Real& wheel_torque_Nm) {
  return wheel_torque_Nm / motor.torque_per_ampere_Nm_A();
}

/// Terminal voltage (V): V = R i + Kv n q'. The inductance is neglected.       [P1, Eq. (15)]
template <class Real>
Real motor_voltage_V(const Motor& motor, const Real& current_A, const Real& wheel_speed_rad_s) {
  return motor.resistance_ohm * current_A + motor.volts_per_speed_V_s_rad() * wheel_speed_rad_s;
}

/// Electrical power (W) of one drive: copper loss plus back-EMF power.
///
///   P = R i^2 + Kv n q' i,  i = tau/(Kt n)                                    [P1, Eq. (28)]
///
/// P < 0 means that the drive returns power; power.hpp computes how much of it the supply recovers.
template <class Real>
Real motor_power_W(const Motor& motor, const Real& wheel_torque_Nm, const Real& wheel_speed_rad_s) {
  const Real current_A = motor_current_A(motor, wheel_torque_Nm);
  return motor_voltage_V(motor, current_A, wheel_speed_rad_s) * current_A;
}

}  // namespace joulepath
