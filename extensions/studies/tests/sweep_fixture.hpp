#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/program_result.hpp"

namespace joulepath {

/// A robot with closed forms for everything: Coulomb friction only, all braking power is recovered.
inline const std::string kSimpleRobot = R"(
geometry: {wheel_radius_m: 0.1, half_track_m: 0.2}
inertia: {chassis_mass_kg: 30, wheel_mass_kg: 0, chassis_yaw_inertia_kg_m2: 1, payload_yaw_inertia_m2: 0,
          wheel_axle_inertia_kg_m2: 0, wheel_diameter_inertia_kg_m2: 0}
motor: {gear_ratio: 20, resistance_ohm: 1.5, torque_constant_Nm_A: 0.05, voltage_constant_V_s_rad: 0.05,
        viscous_friction_Nm_s_rad: 0, friction_torque_Nm: 0.4}
limits: {speed_m_s: 3, acceleration_m_s2: 2, max_payload_kg: 20}
power: {standby_W: 0, regeneration_efficiency: 1, sharing: bus}
battery: {capacity_Wh: 100}
)";
inline const std::string kMission =
    "robot: robot.yaml\nlegs:\n  - {path: {bezier_m: [[[0, 0], [2, 0], [4, 0], [6, 0]]]}, duration_s: 8}\n";

/// Runs `joulepath sweep` on studies of this robot and one mission of it.
class Sweep : public testing::Test {
 protected:
  Sweep() {
    scratch.write("robot.yaml", kSimpleRobot);
    scratch.write("mission.yaml", kMission);
  }

  ProgramResult sweep(const std::string& study, const std::string& more = "") {
    const std::string file = scratch.write("study.yaml", study);
    return run_program(scratch,
                       "sweep " + file + " -q --nodes 100 --force --out " + scratch.at("out") + " " + more);
  }
  nlohmann::json result() const { return nlohmann::json::parse(text_of(scratch.at("out/sweep.json"))); }

  ScratchDirectory scratch;
};

}  // namespace joulepath
