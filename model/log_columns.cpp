#include "model/log_columns.hpp"

namespace joulepath {

#define JOULEPATH_CHANNEL(column, member, measured)                                  \
  LogColumn {                                                                        \
    column, [](Trajectory& t) -> std::vector<double>& { return t.member; }, measured \
  }

const std::vector<LogColumn>& log_columns() {
  static const std::vector<LogColumn> columns{
      JOULEPATH_CHANNEL("time_s", time_s, true),
      JOULEPATH_CHANNEL("wheel_speed_left_rad_s", wheel_speed_rad_s.left, true),
      JOULEPATH_CHANNEL("wheel_speed_right_rad_s", wheel_speed_rad_s.right, true),
      JOULEPATH_CHANNEL("linear_speed_m_s", linear_speed_m_s, true),
      JOULEPATH_CHANNEL("angular_speed_rad_s", angular_speed_rad_s, true),
      JOULEPATH_CHANNEL("motor_voltage_left_V", motor_voltage_V.left, true),
      JOULEPATH_CHANNEL("motor_voltage_right_V", motor_voltage_V.right, true),
      JOULEPATH_CHANNEL("motor_current_left_A", motor_current_A.left, true),
      JOULEPATH_CHANNEL("motor_current_right_A", motor_current_A.right, true),
      JOULEPATH_CHANNEL("motor_power_left_W", motor_power_W.left, true),
      JOULEPATH_CHANNEL("motor_power_right_W", motor_power_W.right, true),
      JOULEPATH_CHANNEL("battery_voltage_V", battery_voltage_V, true),
      JOULEPATH_CHANNEL("battery_current_A", battery_current_A, true),
      JOULEPATH_CHANNEL("gyro_yaw_rate_rad_s", gyro_yaw_rate_rad_s, true),
      JOULEPATH_CHANNEL("position_x_m", position_x_m, true),
      JOULEPATH_CHANNEL("position_y_m", position_y_m, true),
      JOULEPATH_CHANNEL("heading_rad", heading_rad, true),
      JOULEPATH_CHANNEL("command_linear_speed_m_s", command_linear_speed_m_s, true),
      JOULEPATH_CHANNEL("command_angular_speed_rad_s", command_angular_speed_rad_s, true),
      JOULEPATH_CHANNEL("payload_kg", payload_kg, true),
      JOULEPATH_CHANNEL("temperature_C", temperature_C, true),
      JOULEPATH_CHANNEL("arc_length_m", arc_length_m, false),
      JOULEPATH_CHANNEL("linear_acceleration_m_s2", linear_acceleration_m_s2, false),
      JOULEPATH_CHANNEL("curvature_per_m", curvature_per_m, false),
      JOULEPATH_CHANNEL("wheel_torque_left_Nm", wheel_torque_Nm.left, false),
      JOULEPATH_CHANNEL("wheel_torque_right_Nm", wheel_torque_Nm.right, false),
      JOULEPATH_CHANNEL("battery_power_W", battery_power_W, false),
      JOULEPATH_CHANNEL("energy_J", energy_J, false),
      JOULEPATH_CHANNEL("leg", leg, false),
  };
  return columns;
}

#undef JOULEPATH_CHANNEL

const LogColumn* find_log_column(const std::string& name) {
  for (const auto& column : log_columns())
    if (column.name == name) return &column;
  return nullptr;
}

}  // namespace joulepath
