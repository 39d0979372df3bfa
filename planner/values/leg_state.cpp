#include "planner/values/leg_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace joulepath {

bool drifts(const Robot& robot) {
  return !robot.battery.open_circuit_curve.empty() || robot.motor.left.thermal || robot.motor.right.thermal;
}

Robot robot_in(Robot robot, const LegState& state) {
  if (std::isfinite(state.open_circuit_voltage_V))
    robot.battery.open_circuit_voltage_V = state.open_circuit_voltage_V;
  for (const Side side : kSides) robot.motor[side].resistance_ohm *= state.resistance_factor[side];
  return robot;
}

Plant plant_in(Plant plant, const LegState& state) {
  plant.robot = robot_in(std::move(plant.robot), state);
  return plant;
}

std::array<double, 10> drifting_constants(const Plant& plant) {
  const auto& [left, right] = plant.robot.motor;
  return {plant.robot.battery.open_circuit_voltage_V,
          plant.robot.battery.internal_resistance_ohm,
          left.resistance_ohm,
          right.resistance_ohm,
          plant.heat_price_ohm.left,
          plant.heat_price_ohm.right,
          left.max_current_A,
          right.max_current_A,
          left.max_voltage_V,
          right.max_voltage_V};
}

Plant priced_plant_in(Plant plant, const LegState& state) {
  plant = plant_in(std::move(plant), state);
  for (const Side side : kSides) {
    Motor& motor = plant.robot.motor[side];
    plant.heat_price_ohm[side] = state.price_of_heat * motor.resistance_ohm;
    motor.max_current_A = std::min(motor.max_current_A, state.planned_current_A[side]);
  }
  return plant;
}

}  // namespace joulepath
