#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"
#include "model/number_text.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

std::string sided_text(const Sided<double>& value) {
  if (value.left == value.right) return number_text(value.left);
  return "{left: " + number_text(value.left) + ", right: " + number_text(value.right) + "}";
}

/// A flow map `name: {key: value, ...}`; infinite values are absent limits.
class Section {
 public:
  explicit Section(std::string name) : name_(std::move(name)) {}
  Section& number(std::string_view key, double value) {
    return std::isfinite(value) ? raw(key, number_text(value)) : *this;
  }
  Section& raw(std::string_view key, const std::string& value) {
    append_item(body_, std::string(key) + ": " + value);
    return *this;
  }
  [[nodiscard]] std::string line() const { return body_.empty() ? "" : name_ + ": {" + body_ + "}\n"; }

 private:
  std::string name_;
  std::string body_{};
};

std::string thermal_text(const WindingThermal& thermal) {
  return "{resistance_K_W: " + number_text(thermal.resistance_K_W) +
         ", capacity_J_K: " + number_text(thermal.capacity_J_K) +
         ", max_winding_C: " + number_text(thermal.max_winding_C) +
         ", ambient_C: " + number_text(thermal.ambient_C) + "}";
}

std::string motor_line(const Sided<Motor>& motor) {
  Section section("motor");
  const auto add = [&](std::string_view key, double Motor::*field) {
    if (std::isfinite(motor.left.*field))
      section.raw(key, sided_text({motor.left.*field, motor.right.*field}));
  };
  add("gear_ratio", &Motor::gear_ratio);
  add("resistance_ohm", &Motor::resistance_ohm);
  add("torque_constant_Nm_A", &Motor::torque_constant_Nm_A);
  add("voltage_constant_V_s_rad", &Motor::voltage_constant_V_s_rad);
  add("viscous_friction_Nm_s_rad", &Motor::viscous_friction_Nm_s_rad);
  add("friction_torque_Nm", &Motor::friction_torque_Nm);
  add("max_voltage_V", &Motor::max_voltage_V);
  add("max_current_A", &Motor::max_current_A);
  if (motor.left.inductance_H != 0.0 || motor.right.inductance_H != 0.0)
    add("inductance_H", &Motor::inductance_H);
  if (motor.left.thermal) section.raw("thermal", thermal_text(*motor.left.thermal));
  return section.line();
}

std::string limits_line(const Robot& robot) {
  if (!robot.limits) return "";
  Section section("limits");
  for (const Limit& limit : kLimits)
    if (limit.field != nullptr && limit.in_limits) section.number(limit.key, (*robot.limits).*limit.field);
  std::string rows;
  for (const auto& row : robot.limits_by_payload) {
    rows += (rows.empty() ? "{payload_kg: " : ", {payload_kg: ") + number_text(row.payload_kg);
    for (const auto& [key, value] : row.limit_by_key) rows += ", " + key + ": " + number_text(value);
    rows += "}";
  }
  if (!rows.empty()) section.raw("by_payload", "[" + rows + "]");
  const std::string line = section.line();
  return line.empty() ? "limits: {}\n" : line;
}

std::string battery_line(const Battery& battery) {
  Section section("battery");
  section.number("capacity_Wh", battery.capacity_Wh);
  std::string points;
  for (const OpenCircuitPoint& point : battery.open_circuit_curve)
    points += (points.empty() ? "{fraction: " : ", {fraction: ") + number_text(point.fraction) +
              ", V: " + number_text(point.voltage_V) + "}";
  if (points.empty())
    section.number("open_circuit_voltage_V", battery.open_circuit_voltage_V);
  else
    section.raw("open_circuit_voltage", "[" + points + "]");
  return section.number("internal_resistance_ohm", battery.internal_resistance_ohm)
      .number("max_charge_current_A", battery.max_charge_current_A)
      .number("reserve_fraction", battery.reserve_fraction)
      .line();
}

std::string footprint_line(const Footprint& footprint) {
  if (footprint.polygon_m.empty())
    return footprint.radius_m > 0 ? Section("footprint").number("radius_m", footprint.radius_m).line() : "";
  std::string corners;
  for (const auto& corner : footprint.polygon_m)
    corners += (corners.empty() ? "[" : ", [") + number_text(corner[0]) + ", " + number_text(corner[1]) + "]";
  return Section("footprint").raw("polygon_m", "[" + corners + "]").line();
}

std::string effect_line(const EffectSetting& effect) {
  Section section("  - " + effect.name);
  if (effect.side) section.raw("side", side_name(*effect.side));
  for (const auto& [key, value] : effect.parameters) section.number(key, value);
  std::string cells;
  for (const auto& cell : effect.cells)
    cells += (cells.empty() ? "[" : ", [") + number_text(cell[0]) + ", " + number_text(cell[1]) + ", " +
             number_text(cell[2]) + ", " + number_text(cell[3]) + "]";
  if (!cells.empty()) section.raw("cells", "[" + cells + "]");
  if (effect.probability < 1) section.number("probability", effect.probability);
  return section.line();
}

}  // namespace

std::string robot_text(const Robot& robot) {
  std::string text = "schema: joulepath/robot/1\nname: " + quoted(robot.name) + "\n";
  const Geometry& g = robot.geometry;
  text += Section("geometry")
              .raw("wheel_radius_m", sided_text(g.wheel_radius_m))
              .number("half_track_m", g.half_track_m)
              .number("center_of_mass_offset_m", g.center_of_mass_offset_m)
              .line();
  const Inertia& in = robot.inertia;
  text += Section("inertia")
              .number("chassis_mass_kg", in.chassis_mass_kg)
              .number("wheel_mass_kg", in.wheel_mass_kg)
              .number("chassis_yaw_inertia_kg_m2", in.chassis_yaw_inertia_kg_m2)
              .number("payload_yaw_inertia_m2", in.payload_yaw_inertia_m2)
              .number("wheel_axle_inertia_kg_m2", in.wheel_axle_inertia_kg_m2)
              .number("wheel_diameter_inertia_kg_m2", in.wheel_diameter_inertia_kg_m2)
              .line();
  text += motor_line(robot.motor);
  if (robot.payload_offset_m) text += "payload_offset_m: " + number_text(*robot.payload_offset_m) + "\n";
  text += limits_line(robot);
  text += Section("power")
              .number("standby_W", robot.power.standby_W)
              .number("regeneration_efficiency", robot.power.regeneration_efficiency)
              .raw("sharing", robot.power.sharing == PowerSharing::bus ? "bus" : "wheel")
              .line();
  text += battery_line(robot.battery);
  text += footprint_line(robot.footprint);
  if (!robot.effects.empty()) text += "effects:\n";
  for (const auto& effect : robot.effects) text += effect_line(effect);
  Section uncertainty("uncertainty");  // 1 means that a value is unknown; files accept no more
  for (const auto& [key, value] : robot.uncertainty) uncertainty.number(key, std::min(value, 1.0));
  text += uncertainty.line();
  if (!robot.uncertainty_correlations.empty()) text += "uncertainty_correlations:\n";
  for (const Correlation& pair : robot.uncertainty_correlations)
    text += "  - {first: " + pair.first + ", second: " + pair.second +
            ", correlation: " + number_text(pair.correlation) + "}\n";
  return text;
}

}  // namespace joulepath
