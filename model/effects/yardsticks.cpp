#include "model/effects/yardsticks.hpp"

namespace joulepath::robot_measures {
namespace {

double torque_at_wheel_Nm(const Robot& robot, Side side) {
  const double rolling_N = 0.01 * 9.81 * robot.inertia.chassis_mass_kg / 2;  // of a hard tire
  return robot.motor[side].friction_torque_Nm + rolling_N * robot.geometry.wheel_radius_m[side];
}

}  // namespace

double resisting_torque_Nm(const Robot& robot) {
  double sum_Nm = 0;
  for (Side side : kSides) sum_Nm += 0.5 * torque_at_wheel_Nm(robot, side);
  return sum_Nm;
}

double resisting_force_N(const Robot& robot) {
  double sum_N = 0;
  for (Side side : kSides) sum_N += torque_at_wheel_Nm(robot, side) / robot.geometry.wheel_radius_m[side];
  return sum_N;
}

double resisting_moment_Nm(const Robot& robot) {
  return resisting_force_N(robot) * robot.geometry.half_track_m;
}

double resisting_current_A(const Robot& robot) {
  double sum_A = 0;
  for (Side side : kSides)
    sum_A += 0.5 * torque_at_wheel_Nm(robot, side) / robot.motor[side].torque_per_ampere_Nm_A();
  return sum_A;
}

double standby_W(const Robot& robot) { return robot.power.standby_W; }

}  // namespace joulepath::robot_measures
