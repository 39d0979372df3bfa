#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {

/// Limits of a Kobuki for benchmarks: its file has none.
inline Limits kobuki_limits() {
  Limits limits;
  limits.speed_m_s = 0.65, limits.acceleration_m_s2 = limits.deceleration_m_s2 = 0.8;
  limits.yaw_rate_rad_s = 1.9, limits.yaw_acceleration_rad_s2 = 3, limits.lateral_acceleration_m_s2 = 0.5;
  return limits;
}

/// The robots of the campaigns: 6 to 600 kg, each with limits and a largest payload. `folder`: of their
/// files.
inline std::vector<Robot> four_robots(const std::string& folder = "scenarios/robots/") {
  std::vector<Robot> robots;
  for (const char* name : {"nomad_super_scout", "kobuki", "amr_150kg", "tug_600kg"}) {
    Robot robot = read_robot(folder + name + ".yaml");
    if (!robot.limits) robot.limits = kobuki_limits();
    robot.limits->max_payload_kg =
        std::min(robot.limits->max_payload_kg, 0.5 * robot.inertia.chassis_mass_kg);
    robots.push_back(robot);
  }
  return robots;
}

}  // namespace joulepath
