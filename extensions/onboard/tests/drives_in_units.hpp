#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "extensions/onboard/log_stream.hpp"
#include "extensions/onboard/monitor/monitor.hpp"
#include "model/simulation/simulate.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::testing {

inline constexpr const char* kShippedRobots[] = {"nomad_super_scout", "amr_150kg", "tug_600kg", "kobuki",
                                                 "husky_a200"};

inline Robot shipped_robot(const std::string& name) {
  return read_robot(std::string(JOULEPATH_SOURCE_DIR) + "/scenarios/robots/" + name + ".yaml");
}

/// A sound drive of a robot and the log of it: straights at three speeds, arcs, turns in place and stops.
struct SoundDrive {
  Robot robot{};
  PlannedCourse course{};
  Trajectory log{};
};

inline std::vector<PrescribedMotion> motions_of_a_drive(double speed_m_s) {
  std::vector<PrescribedMotion> motions{{.profile = MotionProfile::stand, .duration_s = 1.0}};
  for (const double share : {0.9, 0.5, 0.7}) {
    motions.push_back({.profile = MotionProfile::trapezoid,
                       .acceleration_m_s2 = 0.4 * speed_m_s,
                       .speed_m_s = share * speed_m_s,
                       .distance_m = 5 * speed_m_s});
    motions.push_back({.profile = MotionProfile::stand, .duration_s = 1.0});
    motions.push_back({.profile = MotionProfile::spin,
                       .angle_rad = share < 0.6 ? -2.0 : 2.5,
                       .yaw_rate_rad_s = 0.6,
                       .yaw_acceleration_rad_s2 = 0.6});
    motions.push_back({.profile = MotionProfile::stand, .duration_s = 0.5});
  }
  return motions;
}

inline SoundDrive sound_drive(const std::string& name, double rate_Hz, std::uint64_t seed = 1) {
  SoundDrive drive{.robot = shipped_robot(name)};
  const double speed_m_s = drive.robot.limits ? std::min(drive.robot.limits->speed_m_s, 1.2) : 0.6;
  const TimedMotion motion = timed_motion(drive.robot, motions_of_a_drive(speed_m_s), {.payload_kg = 1.0});
  SimulationRequest request{.robot = drive.robot, .reference = motion.trajectory, .payload_kg = 1.0};
  SimulationResult ideal = simulate(request);
  ideal.executed.payload_kg.assign(ideal.executed.size(), 1.0);
  drive.course = planned_course(drive.robot.geometry, ideal.executed);
  request.sensors = typical_sensors();
  request.sensors.sample_rate_Hz = rate_Hz;
  request.seed = seed;
  drive.log = simulate(request).log;
  drive.log.payload_kg.assign(drive.log.size(), 1.0);
  return drive;
}

/// A channel that a logger writes in another unit, by the column's factor.
struct UnitSlip {
  const char* channel{};  ///< how the columns' names begin
  double factor{};

  void spoil(MonitorRow& row) const {
    const std::string name = channel;
    if (name == "time_s") row.time_s *= factor;
    if (name == "heading_rad") row.heading_rad *= factor;
    if (name == "battery_voltage_V") row.battery_voltage_V *= factor;
    if (name == "battery_current_A") row.battery_current_A *= factor;
    for (const Side side : kSides) {
      if (name == "wheel_speed") row.wheel_speed_rad_s[side] *= factor;
      if (name == "motor_voltage") row.motor_voltage_V[side] *= factor;
      if (name == "motor_current") row.motor_current_A[side] *= factor;
    }
  }
};

inline constexpr double kDegrees = 180 / std::numbers::pi, kRpm = 30 / std::numbers::pi;
inline constexpr UnitSlip kUnitSlips[] = {{"time_s", 1e3},
                                          {"time_s", 1e6},
                                          {"wheel_speed", kRpm},
                                          {"wheel_speed", kDegrees},
                                          {"motor_voltage", 1e3},
                                          {"motor_current", 1e3},
                                          {"battery_voltage_V", 1e3},
                                          {"battery_current_A", 1e3},
                                          {"battery_current_A", 10},
                                          {"heading_rad", kDegrees}};

}  // namespace joulepath::testing
