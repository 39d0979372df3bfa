#pragma once

#include <algorithm>
#include <cmath>

#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

/// A tug of 600 kg on small motors.
inline Robot tug(double max_winding_C) {
  Robot robot = nomad();
  robot.inertia.chassis_mass_kg = 580;
  robot.inertia.wheel_mass_kg = 10;
  robot.inertia.chassis_yaw_inertia_kg_m2 = 80;
  robot.limits->max_payload_kg = 1000;
  robot.battery.capacity_Wh = 2000;
  robot.power.standby_W = 40;
  for (const Side side : kSides) {
    Motor& motor = robot.motor[side];
    motor.resistance_ohm = 1.2, motor.gear_ratio = 30, motor.friction_torque_Nm = 3;
    motor.torque_constant_Nm_A = motor.voltage_constant_V_s_rad = 0.1;
    motor.max_voltage_V = 48, motor.max_current_A = 40;
    motor.thermal = {
        .resistance_K_W = 6, .capacity_J_K = 25, .max_winding_C = max_winding_C, .ambient_C = 25};
  }
  robot.battery.open_circuit_voltage_V = 48;
  return robot;
}

inline MissionRequest starts(int count, double payload_kg = 400, double dwell_s = 1) {
  MissionRequest mission{.name = "starts"};
  for (int k = 0; k < count; ++k)
    mission.legs.push_back({.path = PathRequest{.bezier_m = {{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}}}},
                            .payload = {payload_kg, payload_kg},
                            .dwell_s = dwell_s});
  return mission;
}

inline Plan tow(const MissionRequest& mission, const Robot& robot) {
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 25, .baselines = false});
}

/// The temperatures of both windings from the rows of a plan alone, by small explicit steps.
inline Sided<double> highest_C(const Plan& plan, const Robot& robot) {
  const Trajectory rows = plan_trajectory(plan, make_plant(robot), 40);
  Sided<double> most_C{-300, -300};
  for (const Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const WindingThermal& winding = *motor.thermal;
    double at_C = winding.ambient_C;
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
      const double i2 =
          0.5 * (std::pow(rows.motor_current_A[side][k], 2) + std::pow(rows.motor_current_A[side][k + 1], 2));
      const double ohm = motor.resistance_ohm * (235 + at_C) / (235 + winding.ambient_C);
      at_C += (ohm * i2 - (at_C - winding.ambient_C) / winding.resistance_K_W) / winding.capacity_J_K *
              (rows.time_s[k + 1] - rows.time_s[k]);
      most_C[side] = std::max(most_C[side], at_C);
    }
  }
  return most_C;
}

}  // namespace joulepath::testing
