#include "diagnosis/calibration/calibrated_robot.hpp"

#include <set>

#include "model/dynamics.hpp"
#include "model/nuisance.hpp"

namespace joulepath::calibration {
namespace {

const std::set<std::string> kInherited{"chassis_mass_kg", "wheel_mass_kg", "half_track_m", "wheel_radius_m"};

}  // namespace

DerivedInertia derived_inertia(const Robot& robot, const FitValues& values) {
  const double r = 0.5 * (robot.geometry.wheel_radius_m.left + robot.geometry.wheel_radius_m.right);
  const double l = robot.geometry.half_track_m;
  const MassProperties mass = mass_properties(robot, 0.0);
  const double around_kg_m2 = mass.yaw_inertia_kg_m2 - robot.inertia.chassis_yaw_inertia_kg_m2;
  const double axle = values[kStraightInertia] - mass.mass_kg * r * r / 2;
  return {axle, (values[kTurningInertia] - axle) * 2 * l * l / (r * r) - around_kg_m2};
}

std::vector<InheritedError> inherited_errors(const Robot& robot, const FitValues& values) {
  const DerivedInertia here = derived_inertia(robot, values);
  std::vector<InheritedError> errors;
  for (const Nuisance& nuisance : nuisances_of(robot)) {
    if (!kInherited.contains(nuisance.key)) continue;
    Robot other = robot;
    apply_nuisance(nuisance, nuisance.sigma, other);
    const DerivedInertia there = derived_inertia(other, values);
    errors.push_back(
        {nuisance.key,
         {there.wheel_axle_kg_m2 - here.wheel_axle_kg_m2, there.chassis_yaw_kg_m2 - here.chassis_yaw_kg_m2}});
  }
  return errors;
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
