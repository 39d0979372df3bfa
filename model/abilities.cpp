#include "model/abilities.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "model/power.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {
namespace {

constexpr double kCreeping_m_s = 1e-6;
constexpr double kFastest_m_s = 100;  ///< no wheeled robot is faster
constexpr int kBisections = 60;

Site straight_ahead() { return {.travel_direction = 1, .wheel_direction = {1, 1}}; }

Sided<WheelState<double>> steady_state(const Plant& plant, double speed_m_s) {
  return operating_point(plant, BodyMotion<double>{.speed_m_s = speed_m_s}, straight_ahead());
}

bool motors_allow(const Plant& plant, double speed_m_s) {
  const auto wheels = steady_state(plant, speed_m_s);
  return std::all_of(std::begin(kSides), std::end(kSides), [&](Side side) {
    const Motor& motor = plant.robot.motor[side];
    return wheels[side].voltage_V <= motor.max_voltage_V && wheels[side].current_A <= motor.max_current_A;
  });
}

/// Voltage and current grow with the speed.
double top_speed_m_s(const Plant& plant) {
  if (!motors_allow(plant, kCreeping_m_s)) return 0.0;
  if (motors_allow(plant, kFastest_m_s)) return kNoLimit;
  double low = kCreeping_m_s, high = kFastest_m_s;
  for (int i = 0; i < kBisections; ++i)
    (motors_allow(plant, 0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

/// Rise over run where the weight's part along the slope is this share of it.
double grade_of(double sine) { return sine < 1 ? std::tan(std::asin(std::max(-1.0, sine))) : kNoLimit; }

}  // namespace

Abilities abilities_of(const Robot& robot) {
  const Plant plant = make_plant(robot);
  Abilities able{.top_speed_m_s = top_speed_m_s(plant)};
  const auto at_rest = steady_state(plant, kCreeping_m_s);
  double pull_N = 0.0;
  for (const Side side : kSides) {
    const Motor& motor = plant.robot.motor[side];
    able.motor_torque_Nm[side] = motor.torque_per_ampere_Nm_A() *
                                 std::min(motor.max_current_A, motor.max_voltage_V / motor.resistance_ohm);
    able.friction_torque_Nm[side] = at_rest[side].torque_Nm;
    pull_N += (able.motor_torque_Nm[side] - able.friction_torque_Nm[side]) /
              plant.robot.geometry.wheel_radius_m[side];
  }
  able.grade = grade_of(pull_N / (plant.robot.total_mass_kg(0.0) * kGravity_m_s2));
  const double limit_m_s = robot.limits ? robot.limits->speed_m_s : kNoLimit;
  able.cruise_m_s = std::min({1.0, limit_m_s, able.top_speed_m_s});
  if (!(able.cruise_m_s > 0)) return able;
  const double power_W =
      power_by_cause(plant, BodyMotion<double>{.speed_m_s = able.cruise_m_s}, straight_ahead()).total_W();
  able.energy_J_m = power_W / able.cruise_m_s;
  able.distance_m =
      kJoulesPerWh * robot.battery.capacity_Wh * (1 - robot.battery.reserve_fraction) / able.energy_J_m;
  return able;
}

}  // namespace joulepath
