#include "planner/confidence/plan_demands.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_power.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/charge.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kReach = 3.0;  ///< of the sum of all one-sigma effects: what a place may come to

using ForceUses = std::array<double, kForceLimits>;
void raise(ForceUses& use, const ForceUses& other) {
  for (std::size_t i = 0; i < use.size(); ++i) use[i] = std::max(use[i], other[i]);
}

}  // namespace

const std::array<const Limit*, kForceLimits>& force_limits() {
  static const std::array<const Limit*, kForceLimits> limits = [] {
    std::array<const Limit*, kForceLimits> rows{};
    std::size_t count = 0;
    for (const Limit& row : kLimits)
      if (row.of_forces) rows[count++] = &row;
    return rows;
  }();
  return limits;
}

PlanDemands::PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, ChargeStates charge)
    : plan_(plan), robot_(robot), plant_(plant), charge_(charge) {
  for (const LegPlan& leg : plan.legs)
    limits_.push_back(limits_between_payloads(robot, leg.payload.from_kg, leg.payload.to_kg));
  collect_nodes();
  find_model_friction();
  keep_critical(all_places());
  if (std::isfinite(robot.battery.capacity_Wh)) find_fractions();
}

Limits PlanDemands::limits_on(std::size_t leg, const Plant& plant) const {
  Limits limits = limits_[leg];
  limit_by_battery(limits, plant.robot.battery);
  return limits;
}

std::vector<PlanDemands::Place> PlanDemands::all_places() const {
  constexpr std::array<double, 3> kShares{1e-7, 0.5, 1 - 1e-7};  // of a segment's time
  std::vector<Place> places;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegMotion motion(leg, plant_);
    for (std::size_t i = 0; i < leg.stretches.size(); ++i) {
      const Profile& profile = leg.stretches[i].profile;
      const bool travels = !is_turn(leg.stretches[i].request.piece);
      for (std::size_t j = 0; j + 1 < profile.time_s.size(); ++j)
        for (const double share : kShares) {
          const double time_s = profile.time_s[j] + share * (profile.time_s[j + 1] - profile.time_s[j]);
          const ProfileState state = profile.at_time(time_s);
          const MotionInstant instant = motion_instant(motion.stretch(i), state);
          places.push_back({k, instant.motion, instant.site, travels ? state.acceleration : 0.0});
        }
    }
    if (leg.prescribed)
      motion.integrate([&](const EnergyNode& node) {
        places.push_back({.leg = k, .motion = node.instant.motion, .site = node.instant.site});
      });
  }
  return places;
}

PlanDemands::Uses PlanDemands::uses_at(const Place& place, const Plant& plant, const Limits& limits) {
  const LimitState state = limit_state(plant, place.motion, place.site, place.speed_gain_m_s2, 0.0);
  Uses uses{};
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const Limit& row = *force_limits()[i];
    for (const Side side : kSides) {
      if (side == Side::right && !row.per_wheel) break;
      const double limit = limit_of(row, limits, plant.robot.motor, side);
      if (limit < kNoLimit) uses[i] = std::max(uses[i], limit_fraction(row.value(state, side), limit));
    }
  }
  return uses;
}

void PlanDemands::keep_critical(const std::vector<Place>& all) {
  const std::vector<std::array<Plant, 2>> errors = shifted();
  for (std::size_t leg = 0; leg < plan_.legs.size(); ++leg) {
    const auto on_leg = [&](const Plant& plant) { return plant_in(plant, plan_.legs[leg].state); };
    const Plant here = on_leg(plant_);
    std::vector<std::array<Plant, 2>> errors_here;
    for (const auto& [more, less] : errors) errors_here.push_back({on_leg(more), on_leg(less)});
    for (const Place& place : all) {
      if (place.leg != leg) continue;
      const Uses use = uses_at(place, here, limits_on(leg, here));
      raise(nominal_.use, use);
      Uses most = use;
      for (const auto& pair : errors_here)
        for (const Plant& plant : pair) {
          const Uses other = uses_at(place, plant, limits_on(leg, plant));
          for (std::size_t i = 0; i < use.size(); ++i)
            most[i] += 0.5 * kReach * std::max(0.0, std::abs(other[i] - use[i]));
        }
      if (std::any_of(most.begin(), most.end(), [](double value) { return value >= 1; }))
        places_.push_back(place);
    }
  }
}

void PlanDemands::collect_nodes() {
  for (const LegPlan& leg : plan_.legs) {
    const Plant plant = plant_in(plant_, leg.state);
    auto& nodes = nodes_.emplace_back();
    LegMotion(leg, plant).integrate([&](const EnergyNode& node) { nodes.push_back(node); });
  }
}

void PlanDemands::find_model_friction() {
  const double sigma = robot_.model_energy_sigma().value_or(0.0);
  if (sigma == 0) return;
  constexpr double kStep = 0.01;  // of the friction, and that of a small wheel without any
  const double step_Nm = kStep * std::max({plant_.robot.motor.left.friction_torque_Nm,
                                           plant_.robot.motor.right.friction_torque_Nm, 0.1});
  model_friction_Nm_ = step_Nm;
  const Plant rougher = with_model_error(plant_, 1);
  double motion_J = 0, more_J = 0;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    motion_J += drain_on(k, plant_).motion_J;
    more_J += drain_on(k, rougher).motion_J;
  }
  model_friction_Nm_ = more_J > motion_J ? step_Nm * sigma * std::abs(motion_J) / (more_J - motion_J) : 0.0;
}

Plant PlanDemands::with_model_error(Plant plant, double sigmas) const {
  for (const Side side : kSides) plant.robot.motor[side].friction_torque_Nm += sigmas * model_friction_Nm_;
  return plant;
}

std::vector<std::array<Plant, 2>> PlanDemands::shifted() const {
  std::vector<std::array<Plant, 2>> plants = uncertain(plant_).shifted;
  plants.push_back({with_model_error(plant_, 1), with_model_error(plant_, -1)});
  return plants;
}

void PlanDemands::find_fractions() {
  nominal_.least_fraction = least_fraction(plant_);
  for (const auto& [more, less] : shifted())
    fraction_per_sigma_.push_back(0.5 * (least_fraction(more) - least_fraction(less)));
}

PlanDemands::LegDrain PlanDemands::drain_on(std::size_t leg, const Plant& plant) const {
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

double PlanDemands::least_fraction(const Plant& plant) const {
  const Battery& battery = plant.robot.battery;
  const double standby_W = plant.robot.power.standby_W;
  Charge charge(battery, charge_.start_fraction);
  double least = charge_.start_fraction;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegDrain drain = drain_on(k, plant);
    charge.draw(drain.motion_J + drain.loss_J + standby_W * (leg.duration_s + leg.dwell_s) -
                fed_W(leg, standby_W) * leg.dwell_s);
    least = std::min(least, charge.fraction());
    if (leg.charger_W > standby_W)
      charge.take_up(leg.charger_W - standby_W, leg.dwell_s, charge_.to_fraction);
  }
  return least;
}

double PlanDemands::estimated_fraction(const PlantDraw& draw) const {
  double fraction = nominal_.least_fraction;
  for (std::size_t i = 0; i < fraction_per_sigma_.size(); ++i)
    fraction += fraction_per_sigma_[i] * draw.sigmas[i];
  return fraction;
}

PlanDemand PlanDemands::of(const PlantDraw& draw) const {
  PlanDemand demand;
  const Plant drawn = plant_of(draw);
  for (std::size_t i = 0; i < places_.size();) {
    const std::size_t leg = places_[i].leg;
    const Plant plant = plant_in(drawn, plan_.legs[leg].state);
    const Limits limits = limits_on(leg, plant);
    for (; i < places_.size() && places_[i].leg == leg; ++i)
      raise(demand.use, uses_at(places_[i], plant, limits));
  }
  if (fraction_per_sigma_.empty()) return demand;
  constexpr double kDoubt = 0.5;  // of the change by derivatives: what it may be wrong by
  demand.least_fraction = estimated_fraction(draw);
  const double change = std::abs(demand.least_fraction - nominal_.least_fraction);
  if (demand.least_fraction - kDoubt * change < robot_.battery.reserve_fraction)
    demand.least_fraction = least_fraction(drawn);
  return demand;
}

}  // namespace joulepath
