#include "app/report/columns.hpp"

#include <algorithm>
#include <set>

namespace joulepath::report {
namespace {

void put(Columns& columns, const std::string& name, const std::vector<double>& values) {
  if (!values.empty()) columns[name] = values;
}

void put(Columns& columns, const std::string& stem, const std::string& unit,
         const Sided<std::vector<double>>& values) {
  put(columns, stem + "_left" + unit, values.left);
  put(columns, stem + "_right" + unit, values.right);
}

}  // namespace

Columns columns_of(const Trajectory& t) {
  Columns columns;
  put(columns, "time_s", t.time_s);
  put(columns, "wheel_speed", "_rad_s", t.wheel_speed_rad_s);
  put(columns, "linear_speed_m_s", t.linear_speed_m_s);
  put(columns, "angular_speed_rad_s", t.angular_speed_rad_s);
  put(columns, "motor_voltage", "_V", t.motor_voltage_V);
  put(columns, "motor_current", "_A", t.motor_current_A);
  put(columns, "motor_power", "_W", t.motor_power_W);
  put(columns, "battery_voltage_V", t.battery_voltage_V);
  put(columns, "battery_current_A", t.battery_current_A);
  put(columns, "position_x_m", t.position_x_m);
  put(columns, "position_y_m", t.position_y_m);
  put(columns, "heading_rad", t.heading_rad);
  put(columns, "payload_kg", t.payload_kg);
  put(columns, "arc_length_m", t.arc_length_m);
  put(columns, "linear_acceleration_m_s2", t.linear_acceleration_m_s2);
  put(columns, "curvature_per_m", t.curvature_per_m);
  put(columns, "wheel_torque", "_Nm", t.wheel_torque_Nm);
  put(columns, "battery_power_W", t.battery_power_W);
  put(columns, "energy_J", t.energy_J);
  put(columns, "leg", t.leg);
  return columns;
}

Columns thinned(const Columns& columns, std::size_t most_rows) {
  const auto time = columns.find("time_s");
  const std::size_t rows = time == columns.end() ? 0 : time->second.size();
  if (rows <= most_rows || most_rows < 8) return columns;
  std::vector<const std::vector<double>*> watched;
  for (const char* name :
       {"linear_speed_m_s", "linear_acceleration_m_s2", "battery_power_W", "measured_motor_power_W"})
    if (const auto found = columns.find(name); found != columns.end()) watched.push_back(&found->second);
  const std::size_t kept_per_bucket = 1 + 2 * watched.size();
  const std::size_t bucket = (rows * kept_per_bucket + most_rows - 1) / most_rows;
  std::set<std::size_t> kept{rows - 1};
  for (std::size_t from = 0; from < rows; from += bucket) {
    const auto to = static_cast<std::ptrdiff_t>(std::min(rows, from + bucket));
    kept.insert(from);
    for (const auto* values : watched) {
      const auto begin = values->begin();
      const auto [low, high] = std::minmax_element(begin + static_cast<std::ptrdiff_t>(from), begin + to);
      kept.insert(static_cast<std::size_t>(low - begin));
      kept.insert(static_cast<std::size_t>(high - begin));
    }
  }
  Columns thin;
  for (const auto& [name, values] : columns) {
    auto& out = thin[name];
    for (const std::size_t row : kept) out.push_back(values[row]);
  }
  return thin;
}

}  // namespace joulepath::report
