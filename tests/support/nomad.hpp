#pragma once

#include "model/robot.hpp"

namespace joulepath::testing {

/// The Nomad Super Scout of [P1] with the values that the product uses, without a file.
inline Robot nomad() {
  Motor motor{.gear_ratio = 24.9,
              .resistance_ohm = 2.74,
              .torque_constant_Nm_A = 0.069,
              .voltage_constant_V_s_rad = 0.069,
              .viscous_friction_Nm_s_rad = 0.0017,
              .max_voltage_V = 24.0,
              .max_current_A = 8.0};
  Robot robot{
      .name = "nomad_super_scout",
      .geometry = {.wheel_radius_m = {0.1, 0.1}, .half_track_m = 0.165, .center_of_mass_offset_m = 0.0},
      .inertia = {.chassis_mass_kg = 21.2,
                  .wheel_mass_kg = 1.39,
                  .chassis_yaw_inertia_kg_m2 = 0.5,
                  .payload_yaw_inertia_m2 = 0.02,
                  .wheel_axle_inertia_kg_m2 = 0.0281,
                  .wheel_diameter_inertia_kg_m2 = 0.007},
      .motor = {motor, motor}};
  robot.motor.left.friction_torque_Nm = 0.3728;
  robot.motor.right.friction_torque_Nm = 0.346;
  robot.limits = Limits{.speed_m_s = 1.0,
                        .acceleration_m_s2 = 0.5,
                        .deceleration_m_s2 = 0.5,
                        .lateral_acceleration_m_s2 = 0.5,
                        .yaw_rate_rad_s = 2.0,
                        .yaw_acceleration_rad_s2 = 2.0,
                        .traction_coefficient = 0.6,
                        .max_payload_kg = 12};
  robot.power = {.standby_W = 10.0, .regeneration_efficiency = 0.0};
  robot.battery = {.capacity_Wh = 240,
                   .open_circuit_voltage_V = 25,
                   .internal_resistance_ohm = 0.05,
                   .reserve_fraction = 0.1};
  robot.footprint.radius_m = 0.25;
  return robot;
}

}  // namespace joulepath::testing
