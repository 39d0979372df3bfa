#pragma once

#include <string>
#include <vector>

#include "model/sided.hpp"

namespace joulepath {

/// Pose of the axle midpoint P0 in the map frame; heading counter-clockwise from the x axis.
struct Pose {
  double x_m{};
  double y_m{};
  double heading_rad{};
};

/// A motion over time, planned or measured: one value per sample in every channel that is present, an empty
/// vector for an absent channel. A log is a trajectory that a robot measured; its columns have the same
/// names.
struct Trajectory {
  std::vector<double> time_s{};
  Sided<std::vector<double>> wheel_speed_rad_s{};
  std::vector<double> linear_speed_m_s{};
  std::vector<double> angular_speed_rad_s{};
  Sided<std::vector<double>> motor_voltage_V{};
  Sided<std::vector<double>> motor_current_A{};
  Sided<std::vector<double>> motor_power_W{};
  std::vector<double> battery_voltage_V{};
  std::vector<double> battery_current_A{};
  std::vector<double> gyro_yaw_rate_rad_s{};
  std::vector<double> position_x_m{};
  std::vector<double> position_y_m{};
  std::vector<double> heading_rad{};
  std::vector<double> command_linear_speed_m_s{};
  std::vector<double> command_angular_speed_rad_s{};
  std::vector<double> payload_kg{};
  std::vector<double> temperature_C{};
  // Written by `plan` beside the columns of a log:
  std::vector<double> arc_length_m{};
  std::vector<double> linear_acceleration_m_s2{};
  std::vector<double> curvature_per_m{};
  Sided<std::vector<double>> wheel_torque_Nm{};
  std::vector<double> battery_power_W{};
  std::vector<double> energy_J{};
  std::vector<double> leg{};

  std::size_t size() const { return time_s.size(); }
};

}  // namespace joulepath
