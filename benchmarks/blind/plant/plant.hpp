#pragma once

#include <vector>

#include "machine.hpp"
#include "protocol.hpp"
#include "world.hpp"

namespace blind {

/// The log of perfect sensors for one sample: means over the period that ends at `time_s` (wheel speeds,
/// voltages, currents, battery), instantaneous pose.
struct Sample {
  double time_s{};
  Pair wheel_speed_rad_s{};
  Pair motor_voltage_V{};  ///< commanded output of the driver
  Pair motor_current_A{};
  double battery_voltage_V{};
  double battery_current_A{};
  double gyro_rad_s{};
  double x_m{}, y_m{}, heading_rad{};
  Pair true_power_W{};  ///< at the motors' terminals, for the label only
};

struct Discretization {
  double step_s{2.5e-4};
  bool edges{true};  ///< encoder edges and PWM steps; off = smooth, for derivatives
};

/// Drive one run. Chassis (forward, sideways, yaw) and both wheels are separate bodies; each tyre couples
/// them by a stiff creep force, linear in the contact's sliding speed; each armature current is a state;
/// bearings are LuGre bristles; a 100 Hz PI loop on encoder speed sets the driver's voltage. Fixed steps,
/// linearly implicit in creep, current and bristles, explicit in the rest.
[[nodiscard]] std::vector<Sample> drive(const Machine& truth, const Machine& nominal, const World& world,
                                        const Run& run, const Discretization& discretization);

}  // namespace blind
