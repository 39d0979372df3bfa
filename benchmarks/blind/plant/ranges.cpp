#include "ranges.hpp"

namespace blind {

Scales scales_of(const Machine& m) {
  Scales s{};
  s.torque_Nm = 0.5 * (m.friction_torque_Nm[kLeft] + m.friction_torque_Nm[kRight]);
  s.force_N = 2 * s.torque_Nm / m.wheel_radius_m[kLeft];
  s.current_A = s.torque_Nm / m.torque_per_ampere_Nm_A();
  s.voltage_V = m.open_circuit_voltage_V;
  s.speed_m_s = m.top_speed_m_s;
  s.speed_rad_s = m.top_speed_m_s / m.wheel_radius_m[kLeft];
  s.mass_kg = m.chassis_mass_kg + 2 * m.wheel_mass_kg;
  return s;
}

std::vector<Range> catalog_ranges(const Machine& m) {
  const Scales s = scales_of(m);
  const double moment = s.force_N * m.half_track_m;
  return {{"rolling_resistance", "coefficient", 3e-4, 0.02, false},
          {"floor_patch", "coefficient", 1e-3, 0.06, false},
          {"stribeck_friction", "torque_Nm", 0.01 * s.torque_Nm, 0.5 * s.torque_Nm, false},
          {"coulomb_friction", "torque_Nm", 0.01 * s.torque_Nm, 0.4 * s.torque_Nm, true},
          {"dragging_wheel", "torque_Nm", 0.01 * s.torque_Nm, 0.6 * s.torque_Nm, false},
          {"direction_dependent_friction", "reverse_torque_Nm", 0.01 * s.torque_Nm, 0.5 * s.torque_Nm, false},
          {"viscous_friction", "coefficient_Nm_s_rad", 0.01 * s.torque_Nm / s.speed_rad_s,
           0.7 * s.torque_Nm / s.speed_rad_s, false},
          {"gear_efficiency", "loss_fraction", 0.005, 0.25, false},
          {"turning_scrub", "moment_Nm", 0.02 * moment, 1.3 * moment, false},
          {"caster_swivel", "moment_Nm", 0.04 * moment, 2.0 * moment, false},
          {"quadratic_drag", "coefficient_N_s2_m2", 0.01 * s.force_N / (s.speed_m_s * s.speed_m_s),
           1.2 * s.force_N / (s.speed_m_s * s.speed_m_s), false},
          {"wheel_slip", "creep_stiffness_N_s_m", 3.0 * s.mass_kg, 200.0 * s.mass_kg, false},
          {"payload_mass_error", "fraction", 0.01, 0.45, true},
          {"center_of_mass_offset", "offset_m", 0.01 * m.half_track_m, 0.6 * m.half_track_m, true},
          {"yaw_inertia_error", "fraction", 0.03, 0.9, true},
          {"wheel_radius_error", "fraction", 0.002, 0.06, true},
          {"wheel_radius_mismatch", "fraction", 0.0005, 0.05, true},
          {"track_width_error", "fraction", 0.005, 0.12, true},
          {"floor_slope", "grade", 2e-4, 0.02, false},
          {"winding_resistance_error", "fraction", 0.01, 0.35, true},
          {"winding_heating", "final_fraction", 0.01, 0.4, false},
          {"torque_constant_error", "fraction", 0.004, 0.12, true},
          {"driver_voltage_drop", "voltage_V", 4e-4 * s.voltage_V, 0.025 * s.voltage_V, false},
          {"standby_power_error", "power_W", 0.005 * m.standby_W, 0.6 * m.standby_W, true},
          {"regeneration_error", "efficiency", 0.02, 0.8, false},
          {"supply_sag", "resistance_ohm", 1.3 * m.internal_resistance_ohm, 20 * m.internal_resistance_ohm,
           false},
          {"current_sensor_offset", "offset_A", 0.01 * s.current_A, 0.5 * s.current_A, true},
          {"current_sensor_gain", "fraction", 0.005, 0.15, true},
          {"time_misalignment", "delay_s", 0.004, 0.12, false}};
}

std::vector<Range> foreign_ranges(const Machine& m) {
  const Scales s = scales_of(m);
  return {{"wheel_eccentricity", "torque_Nm", 0.04 * s.torque_Nm, 0.8 * s.torque_Nm, false},
          {"belt_set", "torque_Nm", 0.04 * s.torque_Nm, 1.0 * s.torque_Nm, false},
          {"air_draft", "force_N", 0.03 * s.force_N, 0.8 * s.force_N, false},
          {"flat_spot", "torque_Nm", 0.1 * s.torque_Nm, 2.0 * s.torque_Nm, false},
          {"trailing_cable", "stiffness_N_m", 0.01 * s.force_N, 0.25 * s.force_N, false},
          {"payload_slosh", "fraction", 0.1, 0.9, false},
          {"cold_grease", "torque_Nm", 0.03 * s.torque_Nm, 0.6 * s.torque_Nm, false},
          {"encoder_drift", "fraction_at_400_s", 0.002, 0.05, true},
          {"eddy_brake", "torque_Nm", 0.03 * s.torque_Nm, 0.8 * s.torque_Nm, false},
          {"driver_foldback", "current_A", 0.8 * s.current_A, 2.2 * s.current_A, false}};
}

}  // namespace blind
