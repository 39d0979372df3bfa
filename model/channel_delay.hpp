#pragma once

#include "model/trajectory.hpp"

namespace joulepath {

/// Delays the motors' voltage and current channels by delay_s: linear interpolation between samples, held at
/// the ends.
void delay_motor_channels(Trajectory& log, double delay_s);

}  // namespace joulepath
