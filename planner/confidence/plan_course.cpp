#include "planner/confidence/plan_course.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_power.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/charge.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/legs/leg_motion.hpp"

namespace joulepath {
namespace {

double winding_use(const Motor& motor, const std::vector<Sided<double>>& hottest_C, Side side) {
  if (!motor.thermal) return 0.0;
  double most_C = motor.thermal->ambient_C;
  for (const Sided<double>& on_leg_C : hottest_C) most_C = std::max(most_C, on_leg_C[side]);
  const double allowed_K = motor.thermal->max_winding_C - motor.thermal->ambient_C;
  return allowed_K > 0 ? (most_C - motor.thermal->ambient_C) / allowed_K : 0.0;
}

LegState state_of(const LegCourse& course, LegState state, const Battery& battery) {
  if (!battery.open_circuit_curve.empty())
    state.open_circuit_voltage_V = open_circuit_voltage_V(battery, course.least_fraction);
  state.resistance_factor = course.resistance_factor;
  return state;
}

}  // namespace

Plant DrawnPlant::on(const LegPlan& leg, std::size_t k) const {
  return plant_in(plant,
                  course.legs.empty() ? leg.state : state_of(course.legs[k], leg.state, plant.robot.battery));
}

PlanCourses::PlanCourses(const Plan& plan, const Plant& plant, const ChargeStates& charge)
    : plan_(plan),
      charge_(charge),
      has_capacity_(std::isfinite(plant.robot.battery.capacity_Wh)),
      drifts_(drifts(plant.robot)) {
  for (const LegPlan& leg : plan.legs) {
    const Plant here = plant_in(plant, leg.state);
    auto& nodes = nodes_.emplace_back();
    LegMotion(leg, here).integrate([&](const EnergyNode& node, double) { nodes.push_back(node); });
  }
}

PlanCourses::LegDrain PlanCourses::drain_on(std::size_t leg, const Plant& here) const {
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

double PlanCourses::drawn_J(std::size_t leg, const Plant& here) const {
  const double standby_W = here.robot.power.standby_W;
  const LegPlan& of = plan_.legs[leg];
  const LegDrain drain = drain_on(leg, here);
  return drain.motion_J + drain.loss_J + standby_W * (of.duration_s + of.dwell_s) -
         fed_W(of, standby_W) * of.dwell_s;
}

double PlanCourses::motion_J(const Plant& plant) const {
  double sum_J = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    sum_J += drain_on(k, plant_in(plant, plan_.legs[k].state)).motion_J;
  return sum_J;
}

void PlanCourses::follow_heat(DrawnPlant& drawn) const {
  const auto winding = winding_account(plan_, drawn.plant);
  if (!winding) return;
  PlanCourse& course = drawn.course;
  for (std::size_t k = 0; k < course.legs.size(); ++k)
    course.legs[k].resistance_factor = winding->resistance_factor_on_leg[k];
  for (const Side side : kSides)
    course.winding_use = std::max(
        course.winding_use, winding_use(drawn.plant.robot.motor[side], winding->hottest_on_leg_C, side));
}

/// The voltage on a leg depends on the charge that the leg draws: it is found in two rounds.
void PlanCourses::follow_charge(DrawnPlant& drawn) const {
  const double standby_W = drawn.plant.robot.power.standby_W;
  const bool sags = !drawn.plant.robot.battery.open_circuit_curve.empty();
  PlanCourse& course = drawn.course;
  Charge charge(drawn.plant.robot.battery, charge_.start_fraction);
  course.least_fraction = charge_.start_fraction;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    if (sags) {
      double& least = course.legs[k].least_fraction;
      least = charge.fraction();
      Charge after = charge;
      after.draw(drawn_J(k, drawn.on(leg, k)));
      least = std::min(least, after.fraction());
    }
    charge.draw(drawn_J(k, drawn.on(leg, k)));
    course.least_fraction = std::min(course.least_fraction, charge.fraction());
    if (leg.charger_W > standby_W)
      charge.take_up(leg.charger_W - standby_W, leg.dwell_s, charge_.to_fraction);
  }
}

PlanCourse PlanCourses::of(const Plant& plant) const {
  DrawnPlant drawn{.plant = plant};
  if (drifts_) drawn.course.legs.resize(plan_.legs.size());
  follow_heat(drawn);
  if (has_capacity_) follow_charge(drawn);
  return drawn.course;
}

}  // namespace joulepath
