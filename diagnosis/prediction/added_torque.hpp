#pragma once

#include "model/operating_point.hpp"

namespace joulepath {

/// A wheel whose motor gives that much more torque (N m at the wheel) at the same speed.
inline void add_torque(const Plant& plant, const Site& site, Side side, double torque_Nm,
                       WheelState<double>& wheel) {
  const Motor& motor = plant.robot.motor[side];
  const double before_A = wheel.current_A;
  wheel.torque_Nm += torque_Nm;
  wheel.current_A = motor_current_A(motor, wheel.torque_Nm);
  wheel.voltage_V +=
      plant.resistance_factor(site.time_of_day_s) * motor.resistance_ohm * (wheel.current_A - before_A);
  wheel.power_W = wheel.voltage_V * wheel.current_A;
}

}  // namespace joulepath
