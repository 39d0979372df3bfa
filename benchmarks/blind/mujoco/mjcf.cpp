#include "mjcf.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace blind {
namespace {

constexpr double kTireFriction = 0.9;
// The soft contact yields by half of it, so that the wheels carry the robot.
constexpr double kCasterClearance_m = 3e-4;

/// Throws for effects of the world that MuJoCo cannot model.
void refuse_what_has_no_form(const World& w) {
  World allowed;
  allowed.rolling_coefficient = w.rolling_coefficient;
  allowed.drag_torque_Nm = w.drag_torque_Nm;
  allowed.slope_grade = w.slope_grade;
  allowed.uphill_direction_rad = w.uphill_direction_rad;
  allowed.current_offset_A = w.current_offset_A;
  allowed.current_gain = w.current_gain;
  allowed.electrical_delay_s = w.electrical_delay_s;
  if (!(allowed == w))
    throw std::invalid_argument("MuJoCo has no form of this effect (or of level 1): see mujoco/mjcf.hpp");
}

std::string options(const World& w) {
  std::ostringstream out;
  const double g = kGravity_m_s2;
  out << "<compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n<option timestep=\"" << kPhysicsStep_s
      << "\" integrator=\"implicit\" cone=\"elliptic\" impratio=\"100\" tolerance=\"1e-12\" gravity=\""
      << -g * w.slope_grade * std::cos(w.uphill_direction_rad) << " "
      << -g * w.slope_grade * std::sin(w.uphill_direction_rad) << " " << -g << "\"/>\n";
  return out.str();
}

std::string wheel(const Machine& m, const World& w, std::size_t side, double axle_height_m) {
  const char* name = side == kLeft ? "left" : "right";
  const double radius = m.wheel_radius_m[side];
  const double across = m.wheel_diameter_inertia_kg_m2;
  const double body = std::min(m.wheel_axle_inertia_kg_m2, 1.9 * across);  // a body's inertias obey A + B > C
  std::ostringstream out;
  out << "<body name=\"" << name << "\" pos=\"0 " << (side == kLeft ? 1 : -1) * m.half_track_m << " "
      << radius - axle_height_m << "\">\n  <joint name=\"" << name
      << "\" type=\"hinge\" axis=\"0 1 0\" damping=\"" << m.viscous_friction_Nm_s_rad << "\" frictionloss=\""
      << m.friction_torque_Nm[side] + w.drag_torque_Nm[side] << "\" armature=\""
      << m.wheel_axle_inertia_kg_m2 - body << "\" solreffriction=\"0.002 1\"/>\n"
      << "  <inertial pos=\"0 0 0\" mass=\"" << m.wheel_mass_kg << "\" diaginertia=\"" << across << " "
      << body << " " << across << "\"/>\n  <geom type=\"ellipsoid\" size=\"" << radius << " " << 0.3 * radius
      << " " << radius << "\" contype=\"0\" conaffinity=\"1\" priority=\"2\" solref=\"0.004 1\" condim=\""
      << (w.rolling_coefficient > 0 ? 6 : 3) << "\" friction=\"" << kTireFriction << " 1e-5 "
      << std::max(1e-5, w.rolling_coefficient * radius) << "\"/>\n</body>\n";
  return out.str();
}

std::string caster(double ahead_m, double axle_height_m) {
  const double radius = 0.3 * axle_height_m;
  std::ostringstream out;
  out << "<geom type=\"sphere\" size=\"" << radius << "\" pos=\"" << ahead_m << " 0 "
      << radius + kCasterClearance_m - axle_height_m
      << "\" contype=\"0\" conaffinity=\"1\" priority=\"1\" condim=\"1\" solref=\"0.004 1\"/>\n";
  return out.str();
}

std::string motor(const Machine& m, std::size_t side) {
  const double K = m.torque_per_ampere_Nm_A(), ohm = m.resistance_ohm[side];
  std::ostringstream out;
  out << "<general joint=\"" << (side == kLeft ? "left" : "right") << "\" gaintype=\"fixed\" gainprm=\""
      << K / ohm << "\" biastype=\"affine\" biasprm=\"0 0 " << -K * K / ohm << "\"/>\n";
  return out.str();
}

}  // namespace

std::string mjcf_text(const Machine& m, const World& w, const Run& run) {
  refuse_what_has_no_form(w);
  const double height = 0.5 * (m.wheel_radius_m[kLeft] + m.wheel_radius_m[kRight]);
  const double payload_kg = run.payload_kg * m.payload_factor, inertia = m.chassis_yaw_inertia_kg_m2;
  std::ostringstream out;
  out.precision(12);
  out << "<mujoco model=\"differential_drive\">\n"
      << options(w) << "<worldbody>\n"
      << "<geom name=\"floor\" type=\"plane\" size=\"100 100 1\" contype=\"1\" conaffinity=\"0\"/>\n"
      << "<body name=\"chassis\" pos=\"0 0 " << height << "\" euler=\"0 0 " << run.heading_rad
      << "\">\n<freejoint/>\n"
      << "<inertial pos=\"" << m.center_of_mass_offset_m << " 0 0\" mass=\"" << m.chassis_mass_kg
      << "\" diaginertia=\"" << inertia << " " << inertia << " " << inertia << "\"/>\n"
      << caster(m.half_track_m, height) << caster(-m.half_track_m, height);
  if (payload_kg > 0) {
    const double own = m.payload_yaw_inertia_m2 * payload_kg;
    out << "<body name=\"payload\" pos=\"" << m.center_of_mass_offset_m
        << " 0 0\"><inertial pos=\"0 0 0\" mass=\"" << payload_kg << "\" diaginertia=\"" << own << " " << own
        << " " << own << "\"/></body>\n";
  }
  out << wheel(m, w, kLeft, height) << wheel(m, w, kRight, height) << "</body>\n</worldbody>\n<actuator>\n"
      << motor(m, kLeft) << motor(m, kRight) << "</actuator>\n</mujoco>\n";
  return out.str();
}

}  // namespace blind
