#include "scenarios/log_columns.hpp"

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

Schema column_sources_schema() {
  const Schema source = map({
      optional("from", any_of({text(), list(text(), 1)}),
               "the log's own name; of a list the first that the file has"),
      optional("scale", number(), "value = scale * x + offset"),
      optional("offset", number()),
      optional("unsigned", boolean(), "the sign is taken from the wheel's motion"),
      optional("wraps_at", number(kPositive), "a counter that starts again at 0 there, in the log's unit"),
      optional("derivative", boolean(), "the change per second of what is logged (encoder ticks)"),
      optional("delay_s", number({-10, 10}), "the channel shows what was so long ago"),
  });
  std::vector<Schema::Key> keys;
  for (const auto& column : log_columns())
    if (column.measured) keys.push_back(optional(column.name, source));
  for (const char* name : kOrientationColumns) keys.push_back(optional(name, source));
  return map(std::move(keys));
}

ColumnSources read_column_sources(const Node& node) {
  ColumnSources sources;
  for (const auto& [name, entry] : node.entries()) {
    ColumnSource source{.scale = entry.number_or("scale", 1.0),
                        .offset = entry.number_or("offset", 0.0),
                        .is_unsigned = entry.boolean_or("unsigned", false),
                        .wraps_at = entry.optional_number("wraps_at"),
                        .derivative = entry.boolean_or("derivative", false),
                        .delay_s = entry.number_or("delay_s", 0.0),
                        .mark = entry.mark()};
    if (const auto from = entry.find("from")) {
      if (from->kind() == Value::Kind::list)
        for (const auto& item : from->items()) source.from.push_back(item.text());
      else
        source.from.push_back(from->text());
    }
    if (source.scale == 0.0) entry["scale"].fail("a number other than 0");
    const bool of_wheel = name.rfind("motor_", 0) == 0;
    if (source.is_unsigned && !of_wheel)
      entry["unsigned"].fail("unsigned for motor_* columns only",
                             "the sign comes from the motion of the motor's wheel");
    if (name == "time_s")
      for (const char* key : {"derivative", "delay_s"})
        if (const auto extra = entry.find(key)) extra->fail("no such key", "time_s does not support it");
    sources[name] = std::move(source);
  }
  return sources;
}

}  // namespace joulepath
