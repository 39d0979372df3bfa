#pragma once

#include "model/trajectory.hpp"

namespace joulepath {

/// Makes the motors' voltages and currents show the value of delay_s ago: linear interpolation between
/// samples, held at the ends.
void delay_motor_channels(Trajectory& log, double delay_s);

}  // namespace joulepath
