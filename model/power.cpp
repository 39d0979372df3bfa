#include "model/power.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_charge.hpp"
#include "model/battery_power.hpp"

namespace joulepath {
namespace {

void add_motors(const Plant& plant, const MassProperties& mass, const BodyMotion<double>& motion,
                const Site& site, const Sided<WheelState<double>>& wheels, PowerByCause& watts) {
  const Robot& robot = plant.robot;
  const Wrench<double> inertial = inertial_wrench(mass, motion);
  const Sided<double> acceleration =
      wheel_speeds_rad_s(robot.geometry, motion.acceleration_m_s2, motion.yaw_acceleration_rad_s2);
  const double hot = plant.resistance_factor(site.time_of_day_s);
  watts.kinetic_W = inertial.force_N * motion.speed_m_s + inertial.moment_Nm * motion.yaw_rate_rad_s;
  for (Side side : kSides) {
    const WheelState<double>& wheel = wheels[side];
    const Motor& motor = robot.motor[side];
    watts.copper_W += hot * motor.resistance_ohm * wheel.current_A * wheel.current_A;
    watts.coulomb_friction_W += motor.friction_torque_Nm * site.wheel_direction[side] * wheel.speed_rad_s;
    watts.viscous_friction_W += motor.viscous_friction_Nm_s_rad * wheel.speed_rad_s * wheel.speed_rad_s;
    watts.kinetic_W += robot.inertia.wheel_axle_inertia_kg_m2 * acceleration[side] * wheel.speed_rad_s;
    // Kt i q' equals Kv i q' in SI units; if a file gives different constants, the difference counts as
    // copper loss.
    watts.copper_W += (motor.volts_per_speed_V_s_rad() - motor.torque_per_ampere_Nm_A()) * wheel.current_A *
                      wheel.speed_rad_s;
  }
}

/// What an effect takes at one wheel.
template <class AnEffect>
void add_wheel(const AnEffect& effect, const Robot& robot, double mass_kg, const Site& site, Side side,
               const WheelState<double>& wheel, double& effect_W) {
  const WheelContext<double> context{.site = site,
                                     .side = side,
                                     .speed_rad_s = wheel.speed_rad_s,
                                     .direction = site.wheel_direction[side],
                                     .radius_m = robot.geometry.wheel_radius_m[side],
                                     .normal_load_N = 0.5 * mass_kg * kGravity_m_s2};
  if constexpr (requires { effect.shaft_torque_Nm(context); })
    effect_W += effect.shaft_torque_Nm(context) * wheel.speed_rad_s;
  if constexpr (requires { effect.torque_loss_fraction(); })
    effect_W += effect.torque_loss_fraction() * std::abs(wheel.torque_Nm) * site.wheel_direction[side] *
                wheel.speed_rad_s;
  if constexpr (requires { effect.creep_m_s_N(); })
    effect_W += effect.creep_m_s_N() * wheel.contact_force_N * wheel.contact_force_N;
  if constexpr (requires { effect.voltage_drop_V(); })
    effect_W += effect.voltage_drop_V() * std::abs(wheel.current_A);
}

}  // namespace

double PowerByCause::motor_W() const {
  double sum_W = copper_W + coulomb_friction_W + viscous_friction_W + kinetic_W;
  for (double watts : effect_W) sum_W += watts;
  return sum_W;
}

double PowerByCause::total_W() const { return motor_W() + not_recovered_W + standby_W; }

PowerByCause power_by_cause(const Plant& plant, const BodyMotion<double>& motion, const Site& site) {
  return power_by_cause(plant, motion, site, operating_point(plant, motion, site));
}

PowerByCause power_by_cause(const Plant& plant, const BodyMotion<double>& motion, const Site& site,
                            const Sided<WheelState<double>>& wheels) {
  const Robot& robot = plant.robot;
  const MassProperties mass = mass_properties(robot, plant.payload_kg(site.payload_kg));
  PowerByCause watts{.standby_W = robot.power.standby_W,
                     .effect_W = std::vector<double>(plant.effects.size(), 0.0)};
  add_motors(plant, mass, motion, site, wheels, watts);
  for_each_effect(plant, site.memory, [&](std::size_t index, const auto& effect, double memory) {
    double& effect_W = watts.effect_W[index];
    const double v = motion.speed_m_s, omega = motion.yaw_rate_rad_s;
    const BodyContext<double> body{robot, site, mass.mass_kg, mass.first_moment_kg_m, v, omega, memory};
    if constexpr (requires { effect.body_load(body); }) {
      const BodyLoad<double> load = effect.body_load(body);
      effect_W += load.force_N * v + load.moment_Nm * omega;
    }
    for (Side side : kSides) add_wheel(effect, robot, mass.mass_kg, site, side, wheels[side], effect_W);
  });
  const Sided<double> power_W{wheels.left.power_W, wheels.right.power_W};
  watts.not_recovered_W = supply_power_W(robot.power, power_W) - (power_W.left + power_W.right);
  return watts;
}

double most_battery_power_W(const Battery& battery) {
  const double U = battery.open_circuit_voltage_V, R = battery.internal_resistance_ohm;
  return std::isfinite(U) && R > 0.0 ? U * U / (4 * R) : kNoLimit;
}

double planned_battery_power_W(const Battery& battery) {
  constexpr double kWithin = 1 - 2e-6;  // a plan may exceed a limit by rounding
  return kWithin * most_battery_power_W(battery);
}

double accepted_power_W(const Battery& battery, double fraction, double offered_W) {
  return std::min(offered_W, most_charge_power_W(at_charge(battery, fraction)));
}

double stored_power_W(const Battery& battery, double fraction, double offered_W) {
  const Battery here = at_charge(battery, fraction);
  const double power_W = std::min(offered_W, most_charge_power_W(here));
  return power_W - battery_load(here, -power_W).loss_W;
}

BatteryLoad battery_load(const Battery& battery, double terminal_power_W) {
  const double U = battery.open_circuit_voltage_V;
  const double R = battery.internal_resistance_ohm;
  if (!std::isfinite(U)) return {.terminal_voltage_V = U};
  if (R == 0.0) return {.current_A = terminal_power_W / U, .terminal_voltage_V = U};
  const bool possible = terminal_power_W <= most_battery_power_W(battery);
  const double power_W = std::min(terminal_power_W, most_battery_power_W(battery));
  const double current_A = 2 * power_W / (U + std::sqrt(std::max(0.0, U * U - 4 * R * power_W)));
  return {.possible = possible,
          .current_A = current_A,
          .terminal_voltage_V = U - R * current_A,
          .loss_W = R * current_A * current_A};
}

}  // namespace joulepath
