#include "planner/confidence/plan_energy.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_power.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/charge.hpp"
#include "planner/legs/leg_motion.hpp"

namespace joulepath {

PlanEnergy::PlanEnergy(const Plan& plan, const Plant& plant) : plan_(plan) {
  for (const LegPlan& leg : plan.legs) {
    const Plant here = plant_in(plant, leg.state);
    auto& nodes = nodes_.emplace_back();
    LegMotion(leg, here).integrate([&](const EnergyNode& node) { nodes.push_back(node); });
  }
}

PlanEnergy::LegDrain PlanEnergy::drain_on(std::size_t leg, const Plant& plant) const {
  const Plant here = plant_in(plant, plan_.legs[leg].state);
  const double standby_W = here.robot.power.standby_W;
  LegDrain drain;
  for (const EnergyNode& node : nodes_[leg]) {
    const double power_W = drive_power_W(here, energy_node(here, node.instant, node.time_s, node.weight_s));
    drain.motion_J += node.weight_s * power_W;
    drain.loss_J += node.weight_s * battery_load(here.robot.battery, power_W + standby_W).loss_W;
  }
  drain.loss_J += battery_load(here.robot.battery, standby_W).loss_W * resting_s(plan_.legs[leg], standby_W);
  return drain;
}

double PlanEnergy::motion_J(const Plant& plant) const {
  double sum_J = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) sum_J += drain_on(k, plant).motion_J;
  return sum_J;
}

double PlanEnergy::least_fraction(const Plant& plant, const ChargeStates& states) const {
  const Battery& battery = plant.robot.battery;
  if (!std::isfinite(battery.capacity_Wh)) return 1.0;
  const double standby_W = plant.robot.power.standby_W;
  Charge charge(battery, states.start_fraction);
  double least = states.start_fraction;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegDrain drain = drain_on(k, plant);
    charge.draw(drain.motion_J + drain.loss_J + standby_W * (leg.duration_s + leg.dwell_s) -
                fed_W(leg, standby_W) * leg.dwell_s);
    least = std::min(least, charge.fraction());
    if (leg.charger_W > standby_W) charge.take_up(leg.charger_W - standby_W, leg.dwell_s, states.to_fraction);
  }
  return least;
}

}  // namespace joulepath
