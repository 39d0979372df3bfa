#pragma once

#include <string>

#include "model/effects/catalog.hpp"
#include "model/robot.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath::testing {

/// The robot of a labelled practice set by its label: the true constants and the true effects, instruments
/// left out.
inline Robot true_robot(Robot robot, const std::string& truth_file) {
  const Document document = Document::load(truth_file);
  const Node root = document.root(), constants = root["parameters"];
  for (Side side : kSides) {
    Motor& motor = robot.motor[side];
    motor.friction_torque_Nm = constants["friction_torque_Nm"][side_name(side)].number();
    motor.viscous_friction_Nm_s_rad = constants["viscous_friction_Nm_s_rad"].number();
    motor.resistance_ohm = constants["resistance_ohm"].number();
    motor.torque_constant_Nm_A = motor.voltage_constant_V_s_rad = constants["torque_constant_Nm_A"].number();
    robot.geometry.wheel_radius_m[side] = constants["wheel_radius_m"][side_name(side)].number();
  }
  robot.geometry.half_track_m = constants["half_track_m"].number();
  robot.geometry.center_of_mass_offset_m = constants["center_of_mass_offset_m"].number();
  robot.inertia.chassis_mass_kg = constants["chassis_mass_kg"].number();
  robot.inertia.chassis_yaw_inertia_kg_m2 = constants["chassis_yaw_inertia_kg_m2"].number();
  robot.inertia.wheel_axle_inertia_kg_m2 = constants["wheel_axle_inertia_kg_m2"].number();
  for (const Node& effect : root["effects"].items()) {
    EffectSetting setting{.name = effect["effect"].text()};
    for (const auto& [key, value] : effect.entries()) {
      if (key == "side") setting.side = value.text() == "left" ? Side::left : Side::right;
      if (value.kind() == Value::Kind::scalar && parse_number(value.text()))
        setting.parameters[key] = value.number();
    }
    // The label's constants include these two already.
    const bool counted = setting.name == "center_of_mass_offset" || setting.name == "track_width_error";
    if (!counted && find_effect(setting.name)->info.stage != Stage::instrument)
      robot.effects.push_back(setting);
  }
  return robot;
}

}  // namespace joulepath::testing
