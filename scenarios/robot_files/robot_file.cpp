#include "scenarios/robot_files/robot_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/battery_charge.hpp"
#include "model/limit_table.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/robot_files/effect_list.hpp"
#include "scenarios/robot_files/robot_check.hpp"

namespace joulepath {
namespace {

Sided<double> read_sided(const Node& node) {
  if (node.kind() == Value::Kind::map) return {node["left"].number(), node["right"].number()};
  return {node.number(), node.number()};
}

Geometry read_geometry(const Node& node) {
  return {.wheel_radius_m = read_sided(node["wheel_radius_m"]),
          .half_track_m = node["half_track_m"].number(),
          .center_of_mass_offset_m = node.number_or("center_of_mass_offset_m", 0.0)};
}

Inertia read_inertia(const Node& node) {
  return {.chassis_mass_kg = node["chassis_mass_kg"].number(),
          .wheel_mass_kg = node["wheel_mass_kg"].number(),
          .chassis_yaw_inertia_kg_m2 = node["chassis_yaw_inertia_kg_m2"].number(),
          .payload_yaw_inertia_m2 = node["payload_yaw_inertia_m2"].number(),
          .wheel_axle_inertia_kg_m2 = node["wheel_axle_inertia_kg_m2"].number(),
          .wheel_diameter_inertia_kg_m2 = node["wheel_diameter_inertia_kg_m2"].number()};
}

struct MotorKey {
  const char* name;
  double Motor::*field;
};
constexpr MotorKey kMotorKeys[] = {{"gear_ratio", &Motor::gear_ratio},
                                   {"resistance_ohm", &Motor::resistance_ohm},
                                   {"torque_constant_Nm_A", &Motor::torque_constant_Nm_A},
                                   {"voltage_constant_V_s_rad", &Motor::voltage_constant_V_s_rad},
                                   {"viscous_friction_Nm_s_rad", &Motor::viscous_friction_Nm_s_rad},
                                   {"friction_torque_Nm", &Motor::friction_torque_Nm},
                                   {"max_voltage_V", &Motor::max_voltage_V},
                                   {"max_current_A", &Motor::max_current_A},
                                   {"inductance_H", &Motor::inductance_H}};

WindingThermal read_thermal(const Node& node) {
  const WindingThermal thermal{.resistance_K_W = node["resistance_K_W"].number(),
                               .capacity_J_K = node["capacity_J_K"].number(),
                               .max_winding_C = node["max_winding_C"].number(),
                               .ambient_C = node["ambient_C"].number()};
  if (thermal.max_winding_C <= thermal.ambient_C)
    node["max_winding_C"].fail("a temperature above ambient_C", "the winding begins at ambient_C");
  return thermal;
}

Sided<Motor> read_motors(const Node& node) {
  Sided<Motor> motors;
  for (const auto& key : kMotorKeys)
    if (const auto value = node.find(key.name)) {
      const Sided<double> values = read_sided(*value);
      for (const Side side : kSides) motors[side].*key.field = values[side];
    }
  if (const auto thermal = node.find("thermal"))
    for (const Side side : kSides) motors[side].thermal = read_thermal(*thermal);
  return motors;
}

Limits read_limits(const Node& node) {
  Limits limits;
  for (const Limit& limit : kLimits)
    if (limit.field != nullptr && limit.in_limits) limits.*limit.field = node.number_or(limit.key, kNoLimit);
  return limits;
}

std::vector<PayloadLimits> read_limits_by_payload(const Node& node) {
  std::vector<PayloadLimits> rows;
  for (const auto& item : node.items()) {
    PayloadLimits row{.payload_kg = item["payload_kg"].number()};
    for (const Limit& limit : kLimits)
      if (const auto value = item.optional_number(limit.key))
        row.limit_by_key[std::string(limit.key)] = *value;
    if (!rows.empty() && row.payload_kg <= rows.back().payload_kg)
      item["payload_kg"].fail("a payload greater than the row before", "sort the rows by payload");
    rows.push_back(std::move(row));
  }
  return rows;
}

PowerSupply read_power(const Node& node) {
  return {.standby_W = node.number_or("standby_W", 0.0),
          .regeneration_efficiency = node.number_or("regeneration_efficiency", 0.0),
          .sharing = node.text_or("sharing", "wheel") == "bus" ? PowerSharing::bus : PowerSharing::wheel};
}

/// The points of a battery's open-circuit curve, both values rising.
std::vector<OpenCircuitPoint> read_open_circuit_curve(const Node& node) {
  std::vector<OpenCircuitPoint> curve;
  for (const Node& item : node.items()) {
    const OpenCircuitPoint point{item["fraction"].number(), item["V"].number()};
    if (!curve.empty() && point.fraction <= curve.back().fraction)
      item["fraction"].fail("a fraction above that of the point before", "sort the points by fraction");
    if (!curve.empty() && point.voltage_V <= curve.back().voltage_V)
      item["V"].fail("a voltage above that of the point before", "the voltage rises with the charge");
    curve.push_back(point);
  }
  return curve;
}

Battery read_battery(const Node& node) {
  Battery battery{.capacity_Wh = node.number_or("capacity_Wh", kNoLimit),
                  .open_circuit_voltage_V = node.number_or("open_circuit_voltage_V", kNoLimit),
                  .internal_resistance_ohm = node.number_or("internal_resistance_ohm", 0.0),
                  .reserve_fraction = node.number_or("reserve_fraction", 0.0),
                  .max_charge_current_A = node.number_or("max_charge_current_A", kNoLimit)};
  const auto curve = node.find("open_circuit_voltage");
  if (const auto current = node.find("max_charge_current_A");
      current && !curve && !std::isfinite(battery.open_circuit_voltage_V))
    current->fail_found("a current without a voltage",
                        "open_circuit_voltage or open_circuit_voltage_V beside it");
  if (!curve) return battery;
  if (const auto constant = node.find("open_circuit_voltage_V"))
    constant->fail_found("a constant beside the curve open_circuit_voltage", "one of both");
  battery.open_circuit_curve = read_open_circuit_curve(*curve);
  return at_charge(std::move(battery), 1.0);
}

Footprint read_footprint(const Node& node) {
  Footprint footprint{.radius_m = node.number_or("radius_m", 0.0)};
  const auto polygon = node.find("polygon_m");
  if (!polygon) return footprint;
  for (const auto& corner : polygon->items()) {
    const auto xy = corner.items();
    footprint.polygon_m.push_back({xy[0].number(), xy[1].number()});
  }
  check_polygon(*polygon, footprint.polygon_m);
  double twice_area_m2 = 0.0;
  const auto& p = footprint.polygon_m;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto& q = p[(i + 1) % p.size()];
    twice_area_m2 += p[i][0] * q[1] - q[0] * p[i][1];
  }
  if (std::abs(twice_area_m2) < 1e-9) polygon->fail_found("corners on one line", "a polygon with an area");
  return footprint;
}

/// The pairs of `uncertainty_correlations:` of a robot whose `uncertainty:` is known.
std::vector<Correlation> read_correlations(const Node& node, const Robot& robot) {
  std::vector<Correlation> pairs;
  for (const Node& item : node.items()) {
    pairs.push_back({item["first"].text(), item["second"].text(), item["correlation"].number()});
    check_correlation(item, robot, pairs);
  }
  check_correlation_matrix(node, robot, pairs);
  return pairs;
}

/// Several required values that are absent make one error that lists them.
void check_all_there(const Document& document, const Schema& schema) {
  try {
    check_document(document, "robot", schema);
  } catch (const ConfigError& error) {
    const Node root = document.root();
    const auto is_there = [&](const std::string& key) {
      const std::size_t dot = key.find('.');
      const auto section = root.find(key.substr(0, dot));
      return section && section->kind() == Value::Kind::map && section->has(key.substr(dot + 1));
    };
    std::vector<std::string> missing = required_robot_keys();
    std::erase_if(missing, is_there);
    const auto is_told = [&](const std::string& key) { return key.starts_with(error.detail().key); };
    const bool told = std::any_of(missing.begin(), missing.end(), is_told);
    if (error.detail().found != "nothing" || !told || missing.size() < 2) throw;
    root.fail_found("nothing for " + text_of_list(missing), "a value for each required key",
                    "docs/your_robot.md says where to find them");
  }
}

}  // namespace

Robot robot_from(const Document& document) {
  static const Schema schema = robot_schema();
  check_all_there(document, schema);
  const Node root = document.root();
  Robot robot;
  robot.name = root.text_or("name", std::filesystem::path(document.file()).stem().string());
  robot.geometry = read_geometry(root["geometry"]);
  robot.inertia = read_inertia(root["inertia"]);
  robot.motor = read_motors(root["motor"]);
  robot.payload_offset_m = root.optional_number("payload_offset_m");
  if (const auto limits = root.find("limits")) {
    robot.limits = read_limits(*limits);
    if (const auto rows = limits->find("by_payload")) robot.limits_by_payload = read_limits_by_payload(*rows);
  }
  if (const auto power = root.find("power")) robot.power = read_power(*power);
  if (const auto battery = root.find("battery")) robot.battery = read_battery(*battery);
  if (const auto footprint = root.find("footprint")) robot.footprint = read_footprint(*footprint);
  if (const auto effects = root.find("effects")) robot.effects = read_effect_list(*effects);
  if (const auto uncertainty = root.find("uncertainty"))
    for (const auto& [key, value] : uncertainty->entries()) robot.uncertainty[key] = value.number();
  if (const auto correlations = root.find("uncertainty_correlations"))
    robot.uncertainty_correlations = read_correlations(*correlations, robot);
  check_robot(root, robot);
  return robot;
}

Robot read_robot(const std::string& file, const NamedBy& named_by) {
  return robot_from(Document::load(file, named_by));
}

std::string refusal_of(const Robot& robot) {
  try {
    static_cast<void>(robot_from(Document::parse(robot_text(robot), "")));
    return {};
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    detail.mark = {};
    return ConfigError(detail).what();
  }
}

}  // namespace joulepath
