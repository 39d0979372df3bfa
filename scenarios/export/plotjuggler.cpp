#include "planner/accounts/plan_trajectory.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/text/csv_table.hpp"

namespace joulepath {
namespace {

constexpr double kPlotRate_Hz = 50.0;

/// Signals by PlotJuggler's names: a slash opens a folder of its tree.
CsvColumns signals(const Trajectory& motion) {
  return {{"time_s", &motion.time_s},
          {"pose/x_m", &motion.position_x_m},
          {"pose/y_m", &motion.position_y_m},
          {"pose/heading_rad", &motion.heading_rad},
          {"motion/speed_m_s", &motion.linear_speed_m_s},
          {"motion/acceleration_m_s2", &motion.linear_acceleration_m_s2},
          {"motion/yaw_rate_rad_s", &motion.angular_speed_rad_s},
          {"motion/arc_length_m", &motion.arc_length_m},
          {"motion/curvature_per_m", &motion.curvature_per_m},
          {"left/wheel_speed_rad_s", &motion.wheel_speed_rad_s.left},
          {"left/wheel_torque_Nm", &motion.wheel_torque_Nm.left},
          {"left/motor_voltage_V", &motion.motor_voltage_V.left},
          {"left/motor_current_A", &motion.motor_current_A.left},
          {"left/motor_power_W", &motion.motor_power_W.left},
          {"right/wheel_speed_rad_s", &motion.wheel_speed_rad_s.right},
          {"right/wheel_torque_Nm", &motion.wheel_torque_Nm.right},
          {"right/motor_voltage_V", &motion.motor_voltage_V.right},
          {"right/motor_current_A", &motion.motor_current_A.right},
          {"right/motor_power_W", &motion.motor_power_W.right},
          {"battery/power_W", &motion.battery_power_W},
          {"battery/energy_J", &motion.energy_J},
          {"mission/leg", &motion.leg},
          {"mission/payload_kg", &motion.payload_kg}};
}

}  // namespace

Export export_plotjuggler(const ExportInput& input) {
  const Trajectory motion = plan_trajectory(input.plan, input.plant, input.rate_Hz.value_or(kPlotRate_Hz));
  return {.files = {{input.out_file, csv_text(signals(motion))}}};
}

}  // namespace joulepath
