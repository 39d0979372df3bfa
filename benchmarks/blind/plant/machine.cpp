#include "machine.hpp"

#include <sstream>
#include <stdexcept>

namespace blind {
namespace {

// The Nomad Super Scout of the source paper; inductance and creep are the maker's and a rubber tyre's order.
Machine nomad() {
  Machine m;
  m.name = "nomad_super_scout";
  m.wheel_radius_m = {0.1, 0.1};
  m.half_track_m = 0.165;
  m.chassis_mass_kg = 21.2;
  m.wheel_mass_kg = 1.39;
  m.chassis_yaw_inertia_kg_m2 = 0.5;
  m.payload_yaw_inertia_m2 = 0.02;
  m.wheel_axle_inertia_kg_m2 = 0.0281;
  m.wheel_diameter_inertia_kg_m2 = 0.007;
  m.gear_ratio = 24.9;
  m.resistance_ohm = {2.74, 2.74};
  m.torque_constant_Nm_A = 0.069;
  m.viscous_friction_Nm_s_rad = 0.0017;
  m.friction_torque_Nm = {0.3728, 0.346};
  m.max_voltage_V = 24.0;
  m.max_current_A = 8.0;
  m.standby_W = 10.0;
  m.open_circuit_voltage_V = 25.0;
  m.internal_resistance_ohm = 0.05;
  m.inductance_H = 0.0025;
  m.tyre_creep_N_s_m = 16000;
  m.top_speed_m_s = 1.0;
  m.base_acceleration_m_s2 = 0.2;
  m.base_yaw_rate_rad_s = 0.8;
  m.max_payload_kg = 10.5;
  return m;
}

// A 150 kg goods carrier, drive wheels behind the center of mass, casters fore and aft.
Machine warehouse() {
  Machine m;
  m.name = "warehouse_150";
  m.wheel_radius_m = {0.1, 0.1};
  m.half_track_m = 0.26;
  m.center_of_mass_offset_m = 0.04;
  m.chassis_mass_kg = 143.0;
  m.wheel_mass_kg = 3.5;
  m.chassis_yaw_inertia_kg_m2 = 12.0;
  m.payload_yaw_inertia_m2 = 0.05;
  m.wheel_axle_inertia_kg_m2 = 0.11;
  m.wheel_diameter_inertia_kg_m2 = 0.015;
  m.gear_ratio = 20.0;
  m.resistance_ohm = {0.42, 0.42};
  m.torque_constant_Nm_A = 0.11;
  m.viscous_friction_Nm_s_rad = 0.03;
  m.friction_torque_Nm = {1.9, 2.05};
  m.max_voltage_V = 48.0;
  m.max_current_A = 30.0;
  m.standby_W = 45.0;
  m.regeneration_efficiency = 0.4;
  m.open_circuit_voltage_V = 51.0;
  m.internal_resistance_ohm = 0.06;
  m.inductance_H = 0.0006;
  m.tyre_creep_N_s_m = 60000;
  m.top_speed_m_s = 1.2;
  m.base_acceleration_m_s2 = 0.25;
  m.base_yaw_rate_rad_s = 0.6;
  m.max_payload_kg = 60.0;
  return m;
}

// A table-top robot of 4 kg with small geared motors.
Machine small() {
  Machine m;
  m.name = "small_scout";
  m.wheel_radius_m = {0.035, 0.035};
  m.half_track_m = 0.115;
  m.chassis_mass_kg = 3.6;
  m.wheel_mass_kg = 0.12;
  m.chassis_yaw_inertia_kg_m2 = 0.035;
  m.payload_yaw_inertia_m2 = 0.006;
  m.wheel_axle_inertia_kg_m2 = 0.0009;
  m.wheel_diameter_inertia_kg_m2 = 0.0001;
  m.gear_ratio = 50.0;
  m.resistance_ohm = {4.2, 4.2};
  m.torque_constant_Nm_A = 0.0092;
  m.viscous_friction_Nm_s_rad = 0.0006;
  m.friction_torque_Nm = {0.055, 0.052};
  m.max_voltage_V = 12.0;
  m.max_current_A = 2.0;
  m.standby_W = 4.0;
  m.open_circuit_voltage_V = 14.8;
  m.internal_resistance_ohm = 0.12;
  m.inductance_H = 0.0014;
  m.tyre_creep_N_s_m = 2500;
  m.top_speed_m_s = 0.6;
  m.base_acceleration_m_s2 = 0.25;
  m.base_yaw_rate_rad_s = 1.0;
  m.max_payload_kg = 2.0;
  return m;
}

// The tug of scenarios/robots/tug_600kg.yaml; inductance and creep of the order of its motors and tyres.
Machine tug() {
  Machine m;
  m.name = "tug_600";
  m.wheel_radius_m = {0.125, 0.125};
  m.half_track_m = 0.3;
  m.chassis_mass_kg = 584.0;
  m.wheel_mass_kg = 8.0;
  m.chassis_yaw_inertia_kg_m2 = 113.0;
  m.payload_yaw_inertia_m2 = 0.12;
  m.wheel_axle_inertia_kg_m2 = 0.22;
  m.wheel_diameter_inertia_kg_m2 = 0.031;
  m.gear_ratio = 25.0;
  m.resistance_ohm = {0.12, 0.12};
  m.torque_constant_Nm_A = 0.13;
  m.viscous_friction_Nm_s_rad = 0.1;
  m.friction_torque_Nm = {7.0, 7.0};
  m.max_voltage_V = 48.0;
  m.max_current_A = 55.0;
  m.standby_W = 80.0;
  m.regeneration_efficiency = 0.6;
  m.open_circuit_voltage_V = 51.2;
  m.internal_resistance_ohm = 0.02;
  m.inductance_H = 0.0002;
  m.tyre_creep_N_s_m = 240000;
  m.top_speed_m_s = 1.2;
  m.base_acceleration_m_s2 = 0.2;
  m.base_yaw_rate_rad_s = 0.5;
  m.max_payload_kg = 500.0;
  return m;
}

}  // namespace

Machine nominal_machine(const std::string& name) {
  if (name == "nomad") return nomad();
  if (name == "warehouse") return warehouse();
  if (name == "small") return small();
  if (name == "tug") return tug();
  throw std::invalid_argument("no robot '" + name + "': nomad, warehouse, small or tug");
}

Machine with_nuisance(Machine machine, int index, double sigmas) {
  const Uncertainty u;
  const auto factor = [&](double relative) { return 1.0 + relative * sigmas; };
  switch (index) {
    case 0:
      machine.friction_torque_Nm[kLeft] *= factor(u.friction_torque);
      break;
    case 1:
      machine.friction_torque_Nm[kRight] *= factor(u.friction_torque);
      break;
    case 2:
      machine.viscous_friction_Nm_s_rad *= factor(u.viscous_friction);
      break;
    case 3:
      for (double& r : machine.resistance_ohm) r *= factor(u.resistance);
      break;
    case 4:
      machine.torque_constant_Nm_A *= factor(u.torque_constant);
      break;
    case 5:
      for (double& r : machine.wheel_radius_m) r *= factor(u.wheel_radius);
      break;
    case 6:
      machine.half_track_m *= factor(u.half_track);
      break;
    case 7:
      machine.chassis_mass_kg *= factor(u.chassis_mass);
      break;
    case 8:
      machine.chassis_yaw_inertia_kg_m2 *= factor(u.chassis_yaw_inertia);
      break;
    case 9:
      machine.wheel_axle_inertia_kg_m2 *= factor(u.wheel_axle_inertia);
      break;
    case 10:
      machine.payload_factor *= factor(u.payload);
      break;
    default:
      throw std::invalid_argument("no such nuisance");
  }
  return machine;
}

std::string robot_file(const Machine& m) {
  const Uncertainty u;
  std::ostringstream out;
  out << "schema: joulepath/robot/1\nname: " << m.name
      << "\ngeometry: {wheel_radius_m: " << m.wheel_radius_m[kLeft] << ", half_track_m: " << m.half_track_m
      << ", center_of_mass_offset_m: " << m.center_of_mass_offset_m
      << "}\ninertia: {chassis_mass_kg: " << m.chassis_mass_kg << ", wheel_mass_kg: " << m.wheel_mass_kg
      << ", chassis_yaw_inertia_kg_m2: " << m.chassis_yaw_inertia_kg_m2
      << ", payload_yaw_inertia_m2: " << m.payload_yaw_inertia_m2
      << ", wheel_axle_inertia_kg_m2: " << m.wheel_axle_inertia_kg_m2
      << ", wheel_diameter_inertia_kg_m2: " << m.wheel_diameter_inertia_kg_m2
      << "}\nmotor: {gear_ratio: " << m.gear_ratio << ", resistance_ohm: " << m.resistance_ohm[kLeft]
      << ", torque_constant_Nm_A: " << m.torque_constant_Nm_A
      << ", voltage_constant_V_s_rad: " << m.torque_constant_Nm_A
      << ", viscous_friction_Nm_s_rad: " << m.viscous_friction_Nm_s_rad
      << ", friction_torque_Nm: {left: " << m.friction_torque_Nm[kLeft]
      << ", right: " << m.friction_torque_Nm[kRight] << "}, max_voltage_V: " << m.max_voltage_V
      << ", max_current_A: " << m.max_current_A << "}\npower: {standby_W: " << m.standby_W
      << ", regeneration_efficiency: " << m.regeneration_efficiency
      << "}\nbattery: {open_circuit_voltage_V: " << m.open_circuit_voltage_V
      << ", internal_resistance_ohm: " << m.internal_resistance_ohm
      << "}\nuncertainty: {friction_torque_Nm: " << u.friction_torque
      << ", viscous_friction_Nm_s_rad: " << u.viscous_friction << ", resistance_ohm: " << u.resistance
      << ", chassis_yaw_inertia_kg_m2: " << u.chassis_yaw_inertia
      << ", wheel_axle_inertia_kg_m2: " << u.wheel_axle_inertia << ", chassis_mass_kg: " << u.chassis_mass
      << ", torque_constant_Nm_A: " << u.torque_constant << ", wheel_radius_m: " << u.wheel_radius
      << ", half_track_m: " << u.half_track << ", payload_kg: " << u.payload << "}\n";
  return out.str();
}

std::string true_parameters(const Machine& m) {
  std::ostringstream out;
  out << "{friction_torque_Nm: {left: " << m.friction_torque_Nm[kLeft]
      << ", right: " << m.friction_torque_Nm[kRight]
      << "}, viscous_friction_Nm_s_rad: " << m.viscous_friction_Nm_s_rad
      << ", resistance_ohm: " << m.resistance_ohm[kLeft]
      << ", torque_constant_Nm_A: " << m.torque_constant_Nm_A
      << ", wheel_radius_m: {left: " << m.wheel_radius_m[kLeft] << ", right: " << m.wheel_radius_m[kRight]
      << "}, half_track_m: " << m.half_track_m << ", center_of_mass_offset_m: " << m.center_of_mass_offset_m
      << ", chassis_mass_kg: " << m.chassis_mass_kg
      << ", chassis_yaw_inertia_kg_m2: " << m.chassis_yaw_inertia_kg_m2
      << ", wheel_axle_inertia_kg_m2: " << m.wheel_axle_inertia_kg_m2
      << ", payload_factor: " << m.payload_factor << ", tyre_creep_N_s_m: " << m.tyre_creep_N_s_m << "}";
  return out.str();
}

}  // namespace blind
