#include "model/limit_table.hpp"
#include "scenarios/robot_files/effect_list.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

constexpr Range positive_up_to(double max) { return {0.0, max, true}; }

Schema geometry_schema() {
  return map({required("wheel_radius_m", sided(number(positive_up_to(5))),
                       "radius, not diameter; one value or left and right"),
              required("half_track_m", number(positive_up_to(10)),
                       "HALF the distance between the wheels' contact points"),
              optional("center_of_mass_offset_m", number({-10, 10}),
                       "from the axle midpoint forward to the chassis' center of mass; default 0")});
}

Schema inertia_schema() {
  return map(
      {required("chassis_mass_kg", number(kPositive), "without wheels and rotors"),
       required("wheel_mass_kg", number(kNotNegative), "one wheel and its rotor"),
       required("chassis_yaw_inertia_kg_m2", number(kNotNegative), "about the chassis' own center of mass"),
       required("payload_yaw_inertia_m2", number(kNotNegative),
                "yaw inertia of a payload about its own center, per kg"),
       required("wheel_axle_inertia_kg_m2", number(kNotNegative),
                "wheel and motor about the axle, seen at the wheel, per wheel"),
       required("wheel_diameter_inertia_kg_m2", number(kNotNegative), "wheel and rotor about a diameter")});
}

Schema thermal_schema() {
  return map({required("resistance_K_W", number({0.0, 1e4, true}), "from the winding to the surroundings"),
              required("capacity_J_K", number({0.0, 1e7, true}), "of the winding"),
              required("max_winding_C", number({-50, 400}), "above ambient_C; kept by plans"),
              required("ambient_C", number({-50, 150}),
                       "of the surroundings, and of the cold motor that has "
                       "resistance_ohm; a mission begins with it")});
}

Schema motor_schema() {
  const Schema positive = sided(number(kPositive)), not_negative = sided(number(kNotNegative));
  return map({required("gear_ratio", positive, "motor turns per wheel turn"),
              required("resistance_ohm", positive, "of the winding, warm"),
              required("torque_constant_Nm_A", positive, "Kt, at the motor's shaft"),
              required("voltage_constant_V_s_rad", positive,
                       "Kv, at the motor's shaft; equals Kt in SI units for most motors"),
              required("viscous_friction_Nm_s_rad", not_negative, "seen at the wheel"),
              required("friction_torque_Nm", not_negative, "Coulomb friction, seen at the wheel"),
              optional("max_voltage_V", positive, "absent: no limit"),
              optional("max_current_A", positive, "absent: no limit"),
              optional("inductance_H", not_negative, "only the simulator uses it; default 0"),
              optional("thermal", thermal_schema(),
                       "one thermal node per motor: the copper resistance follows its temperature")});
}

/// Keys of `limits:`, or of a row of `by_payload`.
std::vector<Schema::Key> limit_schema_keys(bool by_payload) {
  std::vector<Schema::Key> keys;
  for (const Limit& limit : kLimits)
    if (limit.field != nullptr && limit.in_limits && (limit.by_payload || !by_payload))
      keys.push_back(optional(std::string(limit.key), number(limit.may_be_zero ? kNotNegative : kPositive),
                              std::string(limit.meaning) + (by_payload ? "; absent: as outside of by_payload"
                                                                       : "; absent: no limit")));
  return keys;
}

Schema limits_schema() {
  std::vector<Schema::Key> keys = limit_schema_keys(false), row = limit_schema_keys(true);
  row.insert(row.begin(), required("payload_kg", number(kNotNegative), "these limits hold at this payload"));
  keys.push_back(optional(
      "by_payload", list(map(row), 1),
      "limits that depend on payload: interpolated between rows, overrides; beyond the rows the nearest "
      "one holds; a row without a key has its value outside of by_payload"));
  return map(std::move(keys));
}

Schema power_schema() {
  return map({optional("standby_W", number(kNotNegative), "computer, sensors, drives at rest; default 0"),
              optional("regeneration_efficiency", number(kFraction),
                       "recovered share of negative motor power; default 0"),
              optional("sharing", choice({"wheel", "bus"}),
                       "wheel: the power of each wheel is clipped; bus: the sum is clipped")});
}

Schema battery_schema() {
  const Schema point = map({required("fraction", number(kFraction), "state of charge"),
                            required("V", number(kPositive), "open-circuit voltage there")});
  return map(
      {optional("capacity_Wh", number(kPositive)),
       optional("open_circuit_voltage_V", number(kPositive), "the same at every charge"),
       optional("open_circuit_voltage", list(point, 2),
                "by state of charge, both rising; linear between the points, constant beyond; the motors' "
                "voltage is then limited by the battery's; instead of open_circuit_voltage_V"),
       optional("internal_resistance_ohm", number(kNotNegative), "default 0"),
       optional("max_charge_current_A", number(kPositive),
                "into the battery, braking and at chargers; absent: no limit"),
       optional("reserve_fraction", number({0.0, 0.99}), "of the capacity that must remain; default 0")});
}

Schema footprint_schema() {
  return map({optional("radius_m", number({1e-3, 100}), "a disc about the axle midpoint"),
              optional("polygon_m", list(list(number({-100, 100}), 2, 2), 3, 1000),
                       "corners [x, y], x forward, y left, origin at the axle midpoint")})
      .with_exactly_one({"radius_m", "polygon_m"});
}

Schema uncertainty_schema() {
  constexpr Range relative{.min = 0.0, .max = 1.0, .why = "relative, 1 sigma: 0.015 is 1.5 %"};
  std::vector<Schema::Key> keys;
  for (const Schema& section :
       {geometry_schema(), inertia_schema(), motor_schema(), power_schema(), battery_schema()})
    for (const auto& key : section.keys)
      if (key.schema.kind == Schema::Kind::number || key.schema.kind == Schema::Kind::any_of)
        keys.push_back(optional(key.name, number(relative)));
  keys.push_back(optional("payload_kg", number(relative)));
  keys.push_back(optional("model_energy", number(relative),
                          "of the model itself: relative 1-sigma of a mission's energy of motion"));
  return map(std::move(keys));
}

Schema correlations_schema() {
  return list(map({required("first", text(), "a key of uncertainty"), required("second", text(), "another"),
                   required("correlation", number({-1, 1}), "of their errors, between -1 and 1")}));
}

}  // namespace

Schema robot_schema() {
  return with_physical_bounds(map(
      {optional("schema", text(), "joulepath/robot/1"), optional("name", text()),
       required("geometry", geometry_schema()), required("inertia", inertia_schema()),
       required("motor", motor_schema(), "each value once, or as {left: , right: }"),
       optional(
           "payload_offset_m", number({-10, 10}),
           "place of a payload's center, forward of the axle midpoint; absent: at center_of_mass_offset_m"),
       optional("limits", limits_schema(), "limits of the motion; required for planning"),
       optional("power", power_schema()), optional("battery", battery_schema()),
       optional("footprint", footprint_schema()),
       optional("effects", effect_list_schema(), "effects added to the nominal model"),
       optional("uncertainty", uncertainty_schema(), "relative 1-sigma of the calibration; absent: unknown"),
       optional("uncertainty_correlations", correlations_schema(),
                "correlations of these errors; pairs that are not listed: 0")}));
}

std::vector<std::string> required_robot_keys() {
  std::vector<std::string> keys;
  for (const Schema::Key& section : robot_schema().keys)
    for (const Schema::Key& key : section.schema.keys)
      if (section.required && key.required) keys.push_back(section.name + "." + key.name);
  return keys;
}

}  // namespace joulepath
