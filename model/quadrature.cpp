#include "model/quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {

EnergyNode energy_node(const Plant& plant, const MotionInstant& instant, double time_s, double weight_s) {
  EnergyNode node{.time_s = time_s, .weight_s = weight_s, .instant = instant};
  if (!instant.stands) node.wheels = operating_point(plant, instant.motion, instant.site);
  return node;
}

double drive_power_W(const Plant& plant, const EnergyNode& node) {
  return supply_power_W(plant.robot.power, {node.wheels.left.power_W, node.wheels.right.power_W});
}

unsigned long branch_of(const Plant& plant, const EnergyNode& node) {
  const double left_W = node.wheels.left.power_W, right_W = node.wheels.right.power_W;
  const Site& site = node.instant.site;
  unsigned long branch = node.instant.stands;
  const auto append = [&](unsigned long choices, unsigned long choice) {
    branch = choices * branch + choice;
  };
  const auto append_sign = [&](double value) { append(3, static_cast<unsigned long>(1 + sign_of(value))); };
  append(8, (left_W > 0) + 2UL * (right_W > 0) + 4UL * (left_W + right_W > 0));
  for (Side side : kSides) append_sign(site.wheel_direction[side]);
  if (plant.effects.empty()) return branch;
  for (Side side : kSides) append_sign(node.wheels[side].current_A);
  append_sign(site.travel_direction);
  append_sign(site.turn_direction);
  for (const Effect& effect : plant.effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.branch(site); }) append(2, e.branch(site));
        },
        effect);
  return branch;
}

void EnergySum::add(const EnergyNode& node) {
  const Robot& robot = plant_->robot;
  const double weight_s = node.weight_s;
  PowerByCause watts{.standby_W = robot.power.standby_W};
  if (!node.instant.stands)
    watts = power_by_cause(*plant_, node.instant.motion, node.instant.site, node.wheels);
  for (double PowerByCause::*cause :
       {&PowerByCause::copper_W, &PowerByCause::coulomb_friction_W, &PowerByCause::viscous_friction_W,
        &PowerByCause::kinetic_W, &PowerByCause::not_recovered_W, &PowerByCause::standby_W})
    joules_.*cause += watts.*cause * weight_s;
  for (std::size_t k = 0; k < watts.effect_W.size(); ++k) joules_.effect_W[k] += watts.effect_W[k] * weight_s;
  for (Side side : kSides) {
    const double power_W = node.wheels[side].power_W;
    motor_J_[side] += power_W * weight_s;
    counted_J_[side] += counted_power_W(power_W, robot.power.regeneration_efficiency) * weight_s;
  }
  const BatteryLoad load = battery_load(robot.battery, watts.total_W());
  battery_loss_J_ += load.loss_W * weight_s;
  lowest_voltage_V_ = std::min(lowest_voltage_V_, load.terminal_voltage_V);
  distance_m_ += std::abs(node.instant.motion.speed_m_s) * weight_s;
}

EnergyByCause EnergySum::by_cause() const {
  EnergyByCause energy;
  energy.add(*plant_, joules_, 1.0);
  return energy;
}

}  // namespace joulepath
