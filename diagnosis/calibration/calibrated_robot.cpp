#include "diagnosis/calibration/calibrated_robot.hpp"

#include <cmath>

#include "model/dynamics.hpp"

namespace joulepath::calibration {

DerivedInertia derived_inertia(const Robot& robot, const FitValues& values) {
  const double r = 0.5 * (robot.geometry.wheel_radius_m.left + robot.geometry.wheel_radius_m.right);
  const double l = robot.geometry.half_track_m;
  const MassProperties mass = mass_properties(robot, 0.0);
  const double around_kg_m2 = mass.yaw_inertia_kg_m2 - robot.inertia.chassis_yaw_inertia_kg_m2;
  const double axle = values[kStraightInertia] - mass.mass_kg * r * r / 2;
  return {axle, (values[kTurningInertia] - axle) * 2 * l * l / (r * r) - around_kg_m2};
}

DerivedInertia geometric_deviation(const Robot& robot, const FitValues& values) {
  const DerivedInertia here = derived_inertia(robot, values);
  DerivedInertia squares{};
  const auto add = [&](const char* key, const auto& change) {
    const auto at = robot.uncertainty.find(key);
    if (at == robot.uncertainty.end()) return;
    Robot other = robot;
    change(other, 1 + at->second);
    const DerivedInertia there = derived_inertia(other, values);
    squares.wheel_axle_kg_m2 += std::pow(there.wheel_axle_kg_m2 - here.wheel_axle_kg_m2, 2);
    squares.chassis_yaw_kg_m2 += std::pow(there.chassis_yaw_kg_m2 - here.chassis_yaw_kg_m2, 2);
  };
  add("chassis_mass_kg", [](Robot& other, double factor) { other.inertia.chassis_mass_kg *= factor; });
  add("wheel_mass_kg", [](Robot& other, double factor) { other.inertia.wheel_mass_kg *= factor; });
  add("half_track_m", [](Robot& other, double factor) { other.geometry.half_track_m *= factor; });
  add("wheel_radius_m", [](Robot& other, double factor) {
    for (Side side : kSides) other.geometry.wheel_radius_m[side] *= factor;
  });
  return {std::sqrt(squares.wheel_axle_kg_m2), std::sqrt(squares.chassis_yaw_kg_m2)};
}

Robot robot_with(const Robot& robot, const FitValues& values) {
  Robot changed = robot;
  const FitValues nominal = nominal_values(robot);
  for (Side side : kSides) {
    const SideRatios ratio = side_ratios(robot, side);
    Motor& motor = changed.motor[side];
    motor.friction_torque_Nm = values[side == Side::left ? kFrictionLeft : kFrictionRight];
    motor.viscous_friction_Nm_s_rad = values[kViscous] * ratio.viscous;
    motor.resistance_ohm = values[kResistance] * ratio.resistance;
    const double scale = values[kTorquePerAmpere] / nominal[kTorquePerAmpere];
    motor.torque_constant_Nm_A *= scale, motor.voltage_constant_V_s_rad *= scale;
  }
  const DerivedInertia inertia = derived_inertia(robot, values);
  const bool straight = values[kStraightInertia] != nominal[kStraightInertia];
  const bool turning = values[kTurningInertia] != nominal[kTurningInertia];
  if (straight && inertia.wheel_axle_kg_m2 >= 0)
    changed.inertia.wheel_axle_inertia_kg_m2 = inertia.wheel_axle_kg_m2;
  if (turning && inertia.chassis_yaw_kg_m2 >= 0)
    changed.inertia.chassis_yaw_inertia_kg_m2 = inertia.chassis_yaw_kg_m2;
  return changed;
}

}  // namespace joulepath::calibration
