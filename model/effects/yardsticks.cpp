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

double resisting_damping_Nm_s(const Robot& robot) {
  double sum = 0;
  for (Side side : kSides) sum += 0.5 * torque_at_wheel_Nm(robot, side) * robot.geometry.wheel_radius_m[side];
  return sum;
}

double half_track_m(const Robot& robot) { return robot.geometry.half_track_m; }
double empty_mass_kg(const Robot& robot) { return robot.total_mass_kg(0.0); }
double standby_W(const Robot& robot) { return robot.power.standby_W; }

}  // namespace joulepath::robot_measures
