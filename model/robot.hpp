#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/limits.hpp"
#include "model/sided.hpp"

namespace joulepath {

inline constexpr double kGravity_m_s2 = 9.80665;

/// Lengths of a two-wheel differential drive [P1, Fig. 1].
struct Geometry {
  Sided<double> wheel_radius_m{};
  double half_track_m{};             ///< l: from the axis of symmetry to a wheel, HALF the track
  double center_of_mass_offset_m{};  ///< d: from the axle midpoint P0 forward to the chassis' center of mass
};

/// Masses and moments of inertia. m = m_c + 2 m_w + m_p.
struct Inertia {
  double chassis_mass_kg{};               ///< m_c: without wheels and rotors
  double wheel_mass_kg{};                 ///< m_w: one wheel and its rotor
  double chassis_yaw_inertia_kg_m2{};     ///< I_c: about the chassis' own center of mass
  double payload_yaw_inertia_m2{};        ///< yaw inertia of a payload about its own center, per kg
  double wheel_axle_inertia_kg_m2{};      ///< I_w + I_s: wheel and motor about the axle, seen at the wheel
  double wheel_diameter_inertia_kg_m2{};  ///< I_m: wheel and rotor about a diameter
};

/// One thermal node of a motor's winding: data-sheet values, from the winding to the surroundings.
struct WindingThermal {
  double resistance_K_W{};
  double capacity_J_K{};
  double max_winding_C{kNoLimit};  ///< less the margin
  double margin_K{};               ///< that a plan leaves for a confidence
  double ambient_C{};              ///< also the temperature at which the motor has its `resistance_ohm`

  bool operator==(const WindingThermal&) const = default;
};

/// One wheel's motor and gear, with friction seen at the wheel [P1, Eqs. (14)-(16)].
struct Motor {
  double gear_ratio{};                 ///< n
  double resistance_ohm{};             ///< R
  double torque_constant_Nm_A{};       ///< Kt
  double voltage_constant_V_s_rad{};   ///< Kv
  double viscous_friction_Nm_s_rad{};  ///< nu
  double friction_torque_Nm{};         ///< T_m: Coulomb friction, opposes the wheel's own motion
  double max_voltage_V{kNoLimit};
  double max_current_A{kNoLimit};
  double inductance_H{};                    ///< L: used by the simulator only; 0 = neglected
  std::optional<WindingThermal> thermal{};  ///< absent: the resistance is constant

  double torque_per_ampere_Nm_A() const { return torque_constant_Nm_A * gear_ratio; }       ///< Kt n
  double volts_per_speed_V_s_rad() const { return voltage_constant_V_s_rad * gear_ratio; }  ///< Kv n
};

/// One row of `limits: by_payload`: the keys given override the limit at this payload; between rows
/// each key is interpolated linearly, and held constant outside of the rows that name it.
struct PayloadLimits {
  double payload_kg{};
  std::map<std::string, double> limit_by_key{};
};

/// How negative motor power is recovered: `wheel` clips each wheel alone, `bus` clips the sum.
enum class PowerSharing { wheel, bus };

struct PowerSupply {
  double standby_W{};
  double regeneration_efficiency{};  ///< eta in [0, 1]: P_battery = max(P, eta P)
  PowerSharing sharing{PowerSharing::wheel};
};

/// Open-circuit voltage at a state of charge.
struct OpenCircuitPoint {
  double fraction{};
  double voltage_V{};
};

struct Battery {
  double capacity_Wh{kNoLimit};
  double open_circuit_voltage_V{kNoLimit};  ///< with a curve: at the present charge, at first a full one
  double internal_resistance_ohm{};
  double reserve_fraction{};                           ///< with the margin
  double reserve_margin{};                             ///< of it: what a plan leaves for a confidence
  std::vector<OpenCircuitPoint> open_circuit_curve{};  ///< rising; empty: the voltage is constant
  double max_charge_current_A{kNoLimit};
};

/// Outline of the robot in its own frame (x forward, origin at the axle midpoint): a disc or a polygon.
struct Footprint {
  double radius_m{};
  std::vector<std::array<double, 2>> polygon_m{};
};

/// One entry of `effects:`: a catalog name with its parameters; `side` where the effect has one.
struct EffectSetting {
  std::string name{};
  std::map<std::string, double> parameters{};
  std::optional<Side> side{};
  std::vector<std::array<double, 4>> cells{};  ///< of a region: x_min, x_max, y_min, y_max each
  double probability{1.0};  ///< that the robot has it: robots that are drawn for a confidence may lack it
};

/// One entry of `uncertainty_correlations:`: between the errors of two keys of `uncertainty:`.
struct Correlation {
  std::string first{}, second{};
  double correlation{};  ///< in (-1, 1)

  bool operator==(const Correlation&) const = default;
};

/// The content of a robot file.
struct Robot {
  std::string name{};
  Geometry geometry{};
  Inertia inertia{};
  Sided<Motor> motor{};
  std::optional<double> payload_offset_m{};  ///< absent: the payload sits at center_of_mass_offset_m
  std::optional<Limits> limits{};
  std::vector<PayloadLimits> limits_by_payload{};
  PowerSupply power{};
  Battery battery{};
  Footprint footprint{};
  std::vector<EffectSetting> effects{};
  std::map<std::string, double> uncertainty{};          ///< relative 1-sigma by key; none: unknown
  std::vector<Correlation> uncertainty_correlations{};  ///< between these errors; absent pairs: 0
  /// Relative 1-sigma of the model's energy of motion, one error for a whole mission, beside the errors of
  /// the constants; nothing: not measured.
  std::optional<double> model_energy_sigma() const {
    const auto stated = uncertainty.find("model_energy");
    return stated == uncertainty.end() ? std::nullopt : std::optional(stated->second);
  }

  double total_mass_kg(double payload_kg) const {
    return inertia.chassis_mass_kg + 2 * inertia.wheel_mass_kg + payload_kg;
  }
  double payload_offset_or_default_m() const {
    return payload_offset_m.value_or(geometry.center_of_mass_offset_m);
  }
};

}  // namespace joulepath
