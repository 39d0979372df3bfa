#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace blind {

inline constexpr double kGravity_m_s2 = 9.80665;
inline constexpr std::size_t kLeft = 0;
inline constexpr std::size_t kRight = 1;
using Pair = std::array<double, 2>;  ///< {left, right}

/// The constants of one machine: those of a robot file (nominal), or the true ones.
struct Machine {
  std::string name{};
  Pair wheel_radius_m{};
  double half_track_m{};
  double center_of_mass_offset_m{};
  double chassis_mass_kg{};
  double wheel_mass_kg{};
  double chassis_yaw_inertia_kg_m2{};
  double payload_yaw_inertia_m2{};
  double wheel_axle_inertia_kg_m2{};
  double wheel_diameter_inertia_kg_m2{};
  double gear_ratio{};
  Pair resistance_ohm{};
  double torque_constant_Nm_A{};
  double viscous_friction_Nm_s_rad{};
  Pair friction_torque_Nm{};
  double max_voltage_V{};
  double max_current_A{};
  double standby_W{};
  double regeneration_efficiency{};
  double open_circuit_voltage_V{};
  double internal_resistance_ohm{};
  double payload_factor{1.0};  ///< true payload / the payload on the label

  // Constants that no robot file has.
  double inductance_H{};
  double tyre_creep_N_s_m{};
  double presliding_angle_rad{0.003};  ///< LuGre: deflection at which the bristles slide

  // Settings of the drive.
  double top_speed_m_s{};
  double base_acceleration_m_s2{};
  double base_yaw_rate_rad_s{};
  double max_payload_kg{};

  double torque_per_ampere_Nm_A() const { return torque_constant_Nm_A * gear_ratio; }
};

/// Relative 1-sigma calibration errors, as in the robot file's `uncertainty`.
struct Uncertainty {
  double friction_torque{0.015};
  double viscous_friction{0.05};
  double resistance{0.01};
  double chassis_yaw_inertia{0.04};
  double wheel_axle_inertia{0.02};
  double chassis_mass{0.005};
  double torque_constant{0.005};
  double wheel_radius{0.003};
  double half_track{0.008};
  double payload{0.01};
};

inline constexpr int kNuisances = 11;

/// The nominal machine of that name: nomad, warehouse, small or tug. Throws std::invalid_argument.
[[nodiscard]] Machine nominal_machine(const std::string& name);

/// `machine` with nuisance `index` (0 .. kNuisances-1) moved by `sigmas` standard deviations.
[[nodiscard]] Machine with_nuisance(Machine machine, int index, double sigmas);

/// The robot file (schema joulepath/robot/1) of a nominal machine.
[[nodiscard]] std::string robot_file(const Machine& nominal);

/// The `parameters:` line of a label: the true constants.
[[nodiscard]] std::string true_parameters(const Machine& truth);

}  // namespace blind
