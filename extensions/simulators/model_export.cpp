#include "extensions/simulators/model_export.hpp"

#include <algorithm>
#include <cmath>

#include "model/number_text.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

constexpr double kCasterGap_m = 3e-4;   ///< casters touch the floor when the chassis pitches
constexpr double kMostAxleShare = 1.9;  ///< moments of inertia of a body obey A + B > C
constexpr double kTireFriction = 0.9;   ///< where the robot file has no traction_coefficient
constexpr double kCasterSize = 0.3;     ///< of the wheel's radius

std::string number(double value) { return number_text(value); }

/// `<name>value</name>`.
std::string tag(const std::string& name, const std::string& value) {
  return "<" + name + ">" + value + "</" + name + ">";
}

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

std::string mjcf_text(const ExportedRobot& robot) {
  std::string wheels, motors, casters;
  for (const ExportedWheel& wheel : robot.wheels) {
    const std::string name = wheel.side;
    const double K = wheel.motor.torque_per_ampere_Nm_A(), Kv = wheel.motor.volts_per_speed_V_s_rad();
    wheels += "      <body name=\"" + name + "_wheel\" pos=\"0 " + number(wheel.y_m) + " " +
              number(wheel.z_m) + "\">\n" + "        <joint name=\"" + name +
              "\" type=\"hinge\" axis=\"0 1 0\" damping=\"" + number(wheel.motor.viscous_friction_Nm_s_rad) +
              "\" frictionloss=\"" + number(wheel.motor.friction_torque_Nm) + "\" armature=\"" +
              number(robot.rotor_kg_m2) + "\" solreffriction=\"0.005 1\"/>\n" +
              "        <inertial pos=\"0 0 0\" mass=\"" + number(robot.wheel_kg) + "\" diaginertia=\"" +
              number(robot.across_kg_m2) + " " + number(robot.body_axle_kg_m2) + " " +
              number(robot.across_kg_m2) + "\"/>\n" + "        <geom type=\"ellipsoid\" size=\"" +
              number(wheel.radius_m) + " " + number(0.3 * wheel.radius_m) + " " + number(wheel.radius_m) +
              "\" contype=\"0\" conaffinity=\"1\" priority=\"2\" solref=\"0.006 1\" friction=\"" +
              number(robot.friction) + " 1e-5 1e-5\"/>\n      </body>\n";
    std::string range;
    if (std::isfinite(wheel.motor.max_voltage_V))
      range = " ctrllimited=\"true\" ctrlrange=\"" + number(-wheel.motor.max_voltage_V) + " " +
              number(wheel.motor.max_voltage_V) + "\"";
    motors += "    <general name=\"" + name + "_V\" joint=\"" + name + "\" gaintype=\"fixed\" gainprm=\"" +
              number(K / wheel.motor.resistance_ohm) + "\" biastype=\"affine\" biasprm=\"0 0 " +
              number(-K * Kv / wheel.motor.resistance_ohm) + "\"" + range + "/>\n";
  }
  for (const double x_m : {robot.caster_m, -robot.caster_m})
    casters += "      <geom type=\"sphere\" size=\"" + number(robot.caster_radius_m) + "\" pos=\"" +
               number(x_m) + " 0 " + number(robot.caster_z_m) +
               "\" contype=\"0\" conaffinity=\"1\" priority=\"1\" condim=\"1\" solref=\"0.006 1\"/>\n";
  return "<mujoco model=\"" + robot.name +
         "\">\n  <!-- Controls are voltages of the motors (V). -->\n"
         "  <compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n"
         "  <option timestep=\"0.002\" integrator=\"implicitfast\" cone=\"elliptic\" impratio=\"100\" "
         "gravity=\"0 0 " +
         number(-kGravity_m_s2) + "\"/>\n" +
         "  <worldbody>\n    <geom name=\"floor\" type=\"plane\" size=\"500 500 1\" contype=\"1\" "
         "conaffinity=\"0\"/>\n" +
         "    <body name=\"base_link\" pos=\"0 0 " + number(robot.radius_m) + "\">\n      <freejoint/>\n" +
         "      <inertial pos=\"" + number(robot.center_m) + " 0 0\" mass=\"" + number(robot.mass_kg) +
         "\" diaginertia=\"" + number(robot.yaw_kg_m2) + " " + number(robot.yaw_kg_m2) + " " +
         number(robot.yaw_kg_m2) + "\"/>\n" + casters + wheels +
         "    </body>\n  </worldbody>\n  <actuator>\n" + motors + "  </actuator>\n</mujoco>\n";
}

/// The drive plugin of Gazebo, the same text in a URDF and in an SDF.
std::string plugin_text(const ExportedRobot& robot) {
  std::string text =
      "    <plugin filename=\"gz-sim-diff-drive-system\" name=\"gz::sim::systems::DiffDrive\">\n      " +
      tag("left_joint", "left") + tag("right_joint", "right") +
      tag("wheel_separation", number(2 * robot.half_track_m)) + tag("wheel_radius", number(robot.radius_m)) +
      "\n";
  const auto limit = [&](const char* name, double value) {
    if (std::isfinite(value)) text += "      " + tag(name, number(value)) + "\n";
  };
  limit("max_linear_velocity", robot.limits.speed_m_s);
  limit("min_linear_velocity", -robot.limits.reverse_speed_m_s);
  limit("max_linear_acceleration", robot.limits.acceleration_m_s2);
  limit("min_linear_acceleration", -robot.limits.deceleration_m_s2);
  limit("max_angular_velocity", robot.limits.yaw_rate_rad_s);
  limit("max_angular_acceleration", robot.limits.yaw_acceleration_rad_s2);
  return text + "    </plugin>\n";
}

std::string urdf_inertial(const std::string& at, double mass_kg, double ixx, double iyy, double izz) {
  return "    <inertial><origin xyz=\"" + at + "\"/><mass value=\"" + number(mass_kg) +
         "\"/><inertia ixx=\"" + number(ixx) + "\" iyy=\"" + number(iyy) + "\" izz=\"" + number(izz) +
         "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>\n";
}

std::string urdf_text(const ExportedRobot& robot) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + robot.name +
                     "\">\n  <link name=\"base_link\">\n" +
                     urdf_inertial(number(robot.center_m) + " 0 0", robot.mass_kg, robot.yaw_kg_m2,
                                   robot.yaw_kg_m2, robot.yaw_kg_m2);
  for (const double x_m : {robot.caster_m, -robot.caster_m})
    text += "    <collision><origin xyz=\"" + number(x_m) + " 0 " + number(robot.caster_z_m) +
            "\"/><geometry><sphere radius=\"" + number(robot.caster_radius_m) +
            "\"/></geometry></collision>\n";
  text += "  </link>\n  <gazebo reference=\"base_link\"><mu1>0</mu1><mu2>0</mu2></gazebo>\n";
  for (const ExportedWheel& wheel : robot.wheels) {
    const std::string name = wheel.side;
    text += "  <joint name=\"" + name + "\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"" +
            name + "_wheel\"/>\n    <origin xyz=\"0 " + number(wheel.y_m) + " " + number(wheel.z_m) +
            "\"/><axis xyz=\"0 1 0\"/><dynamics damping=\"" + number(wheel.motor.viscous_friction_Nm_s_rad) +
            "\" friction=\"" + number(wheel.motor.friction_torque_Nm) + "\"/></joint>\n  <link name=\"" +
            name + "_wheel\">\n" +
            urdf_inertial("0 0 0", robot.wheel_kg, robot.across_kg_m2, robot.body_axle_kg_m2,
                          robot.across_kg_m2) +
            "    <collision><geometry><sphere radius=\"" + number(wheel.radius_m) +
            "\"/></geometry></collision>\n  </link>\n" + "  <gazebo reference=\"" + name + "_wheel\">" +
            tag("mu1", number(robot.friction)) + tag("mu2", number(robot.friction)) + "</gazebo>\n";
  }
  return text + "  <gazebo>\n" + plugin_text(robot) + "  </gazebo>\n</robot>\n";
}

std::string sdf_inertial(const std::string& at, double mass_kg, double ixx, double iyy, double izz) {
  return "      <inertial><pose>" + at + " 0 0 0</pose>" + tag("mass", number(mass_kg)) + "<inertia>" +
         tag("ixx", number(ixx)) + tag("iyy", number(iyy)) + tag("izz", number(izz)) +
         "</inertia></inertial>\n";
}

std::string sdf_sphere(const std::string& name, const std::string& at, double radius_m, double friction) {
  return "      <collision name=\"" + name + "\"><pose>" + at + " 0 0 0</pose><geometry><sphere>" +
         tag("radius", number(radius_m)) + "</sphere></geometry>\n        <surface><friction><ode>" +
         tag("mu", number(friction)) + tag("mu2", number(friction)) +
         "</ode></friction></surface></collision>\n";
}

std::string sdf_text(const ExportedRobot& robot) {
  std::string text = "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\">\n  <model name=\"" + robot.name +
                     "\">\n    <pose>0 0 " + number(robot.radius_m) +
                     " 0 0 0</pose>\n    <link name=\"base_link\">\n" +
                     sdf_inertial(number(robot.center_m) + " 0 0", robot.mass_kg, robot.yaw_kg_m2,
                                  robot.yaw_kg_m2, robot.yaw_kg_m2);
  for (const double x_m : {robot.caster_m, -robot.caster_m})
    text += sdf_sphere(x_m > 0 ? "front" : "back", number(x_m) + " 0 " + number(robot.caster_z_m),
                       robot.caster_radius_m, 0.0);
  text += "    </link>\n";
  for (const ExportedWheel& wheel : robot.wheels) {
    const std::string name = wheel.side;
    text +=
        "    <link name=\"" + name + "_wheel\">\n      <pose>0 " + number(wheel.y_m) + " " +
        number(wheel.z_m) + " 0 0 0</pose>\n" +
        sdf_inertial("0 0 0", robot.wheel_kg, robot.across_kg_m2, robot.body_axle_kg_m2, robot.across_kg_m2) +
        sdf_sphere("tire", "0 0 0", wheel.radius_m, robot.friction) + "    </link>\n    <joint name=\"" +
        name + "\" type=\"revolute\"><parent>base_link</parent><child>" + name +
        "_wheel</child>\n      <axis><xyz>0 1 0</xyz><dynamics>" +
        tag("damping", number(wheel.motor.viscous_friction_Nm_s_rad)) +
        tag("friction", number(wheel.motor.friction_torque_Nm)) + "</dynamics></axis>\n    </joint>\n";
  }
  return text + plugin_text(robot) + "  </model>\n</sdf>\n";
}

}  // namespace

ModelExport model_export(const Robot& robot, double payload_kg, const std::string& format) {
  const ExportedRobot out = exported(robot, payload_kg);
  ModelExport result{.text = format == "mjcf"   ? mjcf_text(out)
                             : format == "urdf" ? urdf_text(out)
                                                : sdf_text(out)};
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
