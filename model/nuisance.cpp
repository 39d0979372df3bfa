#include "model/nuisance.hpp"

#include <functional>
#include <map>

namespace joulepath {
namespace {

using Change = std::function<void(Robot&, Side, double factor)>;

template <class Member>
Change motor_constant(Member member) {
  return [member](Robot& robot, Side side, double factor) { robot.motor[side].*member *= factor; };
}

/// Constants that both sides share change on the call for the left side only.
template <class Part, class Member>
Change shared(Part part, Member member) {
  return [part, member](Robot& robot, Side side, double factor) {
    if (side == Side::left) robot.*part.*member *= factor;
  };
}

const std::map<std::string, Change>& changes() {
  static const std::map<std::string, Change> table{
      {"wheel_radius_m",
       [](Robot& robot, Side side, double factor) { robot.geometry.wheel_radius_m[side] *= factor; }},
      {"half_track_m", shared(&Robot::geometry, &Geometry::half_track_m)},
      {"center_of_mass_offset_m", shared(&Robot::geometry, &Geometry::center_of_mass_offset_m)},
      {"chassis_mass_kg", shared(&Robot::inertia, &Inertia::chassis_mass_kg)},
      {"wheel_mass_kg", shared(&Robot::inertia, &Inertia::wheel_mass_kg)},
      {"chassis_yaw_inertia_kg_m2", shared(&Robot::inertia, &Inertia::chassis_yaw_inertia_kg_m2)},
      {"payload_yaw_inertia_m2", shared(&Robot::inertia, &Inertia::payload_yaw_inertia_m2)},
      {"wheel_axle_inertia_kg_m2", shared(&Robot::inertia, &Inertia::wheel_axle_inertia_kg_m2)},
      {"wheel_diameter_inertia_kg_m2", shared(&Robot::inertia, &Inertia::wheel_diameter_inertia_kg_m2)},
      {"gear_ratio", motor_constant(&Motor::gear_ratio)},
      {"resistance_ohm", motor_constant(&Motor::resistance_ohm)},
      {"torque_constant_Nm_A",
       [](Robot& robot, Side side, double factor) {
         robot.motor[side].torque_constant_Nm_A *= factor;
         robot.motor[side].voltage_constant_V_s_rad *= factor;  // Kt and Kv belong to one magnet
       }},
      {"voltage_constant_V_s_rad", motor_constant(&Motor::voltage_constant_V_s_rad)},
      {"viscous_friction_Nm_s_rad", motor_constant(&Motor::viscous_friction_Nm_s_rad)},
      {"friction_torque_Nm", motor_constant(&Motor::friction_torque_Nm)},
      {"standby_W", shared(&Robot::power, &PowerSupply::standby_W)},
      {"regeneration_efficiency", shared(&Robot::power, &PowerSupply::regeneration_efficiency)},
      {"open_circuit_voltage_V", shared(&Robot::battery, &Battery::open_circuit_voltage_V)},
      {"internal_resistance_ohm", shared(&Robot::battery, &Battery::internal_resistance_ohm)},
      {"payload_kg", [](Robot&, Side, double) {}},
  };
  return table;
}

}  // namespace

std::vector<Nuisance> nuisances_of(const Robot& robot) {
  std::vector<Nuisance> nuisances;
  for (const auto& [key, sigma] : robot.uncertainty) {
    if (sigma <= 0 || !changes().contains(key)) continue;
    if (key == "friction_torque_Nm")
      for (Side side : kSides) nuisances.push_back({key, side, sigma});
    else
      nuisances.push_back({key, std::nullopt, sigma});
  }
  return nuisances;
}

void apply_nuisance(const Nuisance& nuisance, double fraction, Robot& robot) {
  const auto found = changes().find(nuisance.key);
  if (found == changes().end()) return;
  for (Side side : kSides)
    if (!nuisance.side || *nuisance.side == side) found->second(robot, side, 1.0 + fraction);
}

bool is_payload_nuisance(const Nuisance& nuisance) { return nuisance.key == "payload_kg"; }

}  // namespace joulepath
