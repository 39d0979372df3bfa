#include "extensions/simulators/model_export.hpp"

#include <algorithm>
#include <cmath>

#include "model/number_text.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/filled.hpp"

/// The files of extensions/simulators/templates/.
namespace joulepath::embedded {
extern const std::string_view mjcf, mjcf_caster, mjcf_wheel, mjcf_motor, urdf, urdf_caster, urdf_wheel, sdf,
    sdf_caster, sdf_wheel, plugin;
}  // namespace joulepath::embedded

namespace joulepath {
namespace {

constexpr double kCasterGap_m = 3e-4;   ///< casters touch the floor when the chassis pitches
constexpr double kMostAxleShare = 1.9;  ///< moments of inertia of a body obey A + B > C
constexpr double kTireFriction = 0.9;   ///< where the robot file has no traction_coefficient
constexpr double kCasterSize = 0.3;     ///< of the wheel's radius

std::string number(double value) { return number_text(value); }

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return safe;
}

struct ExportedWheel {
  const char* side;
  double y_m, z_m, radius_m;
  Motor motor;
};

/// What all three formats write.
struct ExportedRobot {
  std::string name{};
  double radius_m{}, mass_kg{}, center_m{}, yaw_kg_m2{}, wheel_kg{}, across_kg_m2{}, body_axle_kg_m2{},
      rotor_kg_m2{};
  double caster_m{}, caster_radius_m{}, caster_z_m{}, friction{};
  std::vector<ExportedWheel> wheels{};
  double half_track_m{};
  Limits limits{};
};

ExportedRobot exported(const Robot& robot, double payload_kg) {
  const Geometry& geometry = robot.geometry;
  const Inertia& inertia = robot.inertia;
  ExportedRobot out{.name = escaped(robot.name)};
  const double offset_m = robot.payload_offset_or_default_m(), chassis_m = geometry.center_of_mass_offset_m;
  out.radius_m = 0.5 * (geometry.wheel_radius_m.left + geometry.wheel_radius_m.right);
  out.mass_kg = inertia.chassis_mass_kg + payload_kg;
  out.center_m = (inertia.chassis_mass_kg * chassis_m + payload_kg * offset_m) / out.mass_kg;
  out.yaw_kg_m2 = inertia.chassis_yaw_inertia_kg_m2 + payload_kg * inertia.payload_yaw_inertia_m2 +
                  inertia.chassis_mass_kg * std::pow(chassis_m - out.center_m, 2) +
                  payload_kg * std::pow(offset_m - out.center_m, 2);
  out.wheel_kg = inertia.wheel_mass_kg;
  out.across_kg_m2 = inertia.wheel_diameter_inertia_kg_m2;
  out.body_axle_kg_m2 = std::min(inertia.wheel_axle_inertia_kg_m2, kMostAxleShare * out.across_kg_m2);
  out.rotor_kg_m2 = inertia.wheel_axle_inertia_kg_m2 - out.body_axle_kg_m2;
  out.caster_m = std::max(geometry.half_track_m, 2 * std::abs(out.center_m));
  out.caster_radius_m = kCasterSize * out.radius_m;
  out.caster_z_m = out.caster_radius_m + kCasterGap_m - out.radius_m;
  const Limits limits = robot.limits.value_or(Limits{});
  out.friction = std::isfinite(limits.traction_coefficient) ? limits.traction_coefficient : kTireFriction;
  out.half_track_m = geometry.half_track_m;
  out.limits = limits;
  for (const Side side : kSides) {
    const double r = geometry.wheel_radius_m[side], sign = side == Side::left ? 1 : -1;
    out.wheels.push_back({side == Side::left ? "left" : "right", sign * geometry.half_track_m,
                          r - out.radius_m, r, robot.motor[side]});
  }
  return out;
}

/// The text of one format, of its parts.
struct Templates {
  std::string_view model, caster, wheel, motor;
};

Templates templates_of(const std::string& format) {
  using namespace embedded;
  if (format == "mjcf") return {mjcf, mjcf_caster, mjcf_wheel, mjcf_motor};
  if (format == "urdf") return {urdf, urdf_caster, urdf_wheel, {}};
  return {sdf, sdf_caster, sdf_wheel, {}};
}

Fillings robot_values(const ExportedRobot& robot) {
  return {{"@NAME@", robot.name},
          {"@GRAVITY@", number(-kGravity_m_s2)},
          {"@RADIUS@", number(robot.radius_m)},
          {"@TRACK@", number(2 * robot.half_track_m)},
          {"@MASS@", number(robot.mass_kg)},
          {"@CENTER@", number(robot.center_m)},
          {"@YAW@", number(robot.yaw_kg_m2)},
          {"@WHEEL_MASS@", number(robot.wheel_kg)},
          {"@ACROSS@", number(robot.across_kg_m2)},
          {"@AXLE@", number(robot.body_axle_kg_m2)},
          {"@ROTOR@", number(robot.rotor_kg_m2)},
          {"@CASTER_RADIUS@", number(robot.caster_radius_m)},
          {"@CASTER_Z@", number(robot.caster_z_m)},
          {"@FRICTION@", number(robot.friction)}};
}

Fillings wheel_values(const ExportedWheel& wheel) {
  const Motor& motor = wheel.motor;
  const double K = motor.torque_per_ampere_Nm_A(), Kv = motor.volts_per_speed_V_s_rad();
  std::string range;
  if (std::isfinite(motor.max_voltage_V))
    range = " ctrllimited=\"true\" ctrlrange=\"" + number(-motor.max_voltage_V) + " " +
            number(motor.max_voltage_V) + "\"";
  return {{"@SIDE@", wheel.side},
          {"@Y@", number(wheel.y_m)},
          {"@Z@", number(wheel.z_m)},
          {"@WHEEL_RADIUS@", number(wheel.radius_m)},
          {"@WHEEL_WIDTH@", number(0.3 * wheel.radius_m)},
          {"@DAMPING@", number(motor.viscous_friction_Nm_s_rad)},
          {"@DRY@", number(motor.friction_torque_Nm)},
          {"@GAIN@", number(K / motor.resistance_ohm)},
          {"@BIAS@", number(-K * Kv / motor.resistance_ohm)},
          {"@RANGE@", range}};
}

/// Limits of Gazebo's drive plugin, the same in a URDF and in an SDF.
std::string plugin_limits(const Limits& limits) {
  std::string text;
  for (const auto& [name, value] : {std::pair{"max_linear_velocity", limits.speed_m_s},
                                    {"min_linear_velocity", -limits.reverse_speed_m_s},
                                    {"max_linear_acceleration", limits.acceleration_m_s2},
                                    {"min_linear_acceleration", -limits.deceleration_m_s2},
                                    {"max_angular_velocity", limits.yaw_rate_rad_s},
                                    {"max_angular_acceleration", limits.yaw_acceleration_rad_s2}})
    if (std::isfinite(value))
      text += "      <" + std::string(name) + ">" + number(value) + "</" + name + ">\n";
  return text;
}

std::string model_text(const ExportedRobot& robot, const Templates& templates) {
  const auto add = [](Fillings values, const Fillings& more) {
    values.insert(values.end(), more.begin(), more.end());
    return values;
  };
  const Fillings values = robot_values(robot);
  std::string casters, wheels, motors;
  for (const double x_m : {robot.caster_m, -robot.caster_m})
    casters +=
        filled(templates.caster, add(values, {{"@X@", number(x_m)}, {"@END@", x_m > 0 ? "front" : "back"}}));
  for (const ExportedWheel& wheel : robot.wheels) {
    const Fillings of_wheel = add(values, wheel_values(wheel));
    wheels += filled(templates.wheel, of_wheel);
    motors += filled(templates.motor, of_wheel);
  }
  const std::string plugin =
      filled(embedded::plugin, add(values, {{"@LIMITS@", plugin_limits(robot.limits)}}));
  return filled(
      templates.model,
      add(values,
          {{"@CASTERS@", casters}, {"@WHEELS@", wheels}, {"@MOTORS@", motors}, {"@PLUGIN@", plugin}}));
}

}  // namespace

ModelExport model_export(const Robot& robot, double payload_kg, const std::string& format) {
  const ExportedRobot out = exported(robot, payload_kg);
  ModelExport result{.text = model_text(out, templates_of(format))};
  if (!robot.effects.empty())
    result.lost.push_back("effects: " + text_of_list(robot.effects, &EffectSetting::name));
  if (format == "mjcf") return result;
  result.lost.push_back("motors: resistance, constants and gear; the drive plugin holds its speeds exactly");
  if (out.rotor_kg_m2 > 0)
    result.lost.push_back(number(out.rotor_kg_m2) +
                          " kg m2 of wheel_axle_inertia_kg_m2: no rigid wheel has more than twice "
                          "its inertia about a diameter, the rest is the rotor's");
  return result;
}

}  // namespace joulepath
