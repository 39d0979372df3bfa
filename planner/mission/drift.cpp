#include "planner/mission/drift.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_charge.hpp"
#include "model/winding.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr int kDriftRounds = 8, kFreeRounds = 4;
constexpr double kSameVoltage = 1e-5, kSameResistance = 5e-4;  ///< relative
constexpr int kHundred = 100;

/// Open-circuit voltage (V) of a state; none where it is constant.
double voltage_at_V(const Robot& robot, double fraction) {
  return robot.battery.open_circuit_curve.empty() ? kNoLimit
                                                  : open_circuit_voltage_V(robot.battery, fraction);
}

/// The resistance that a plan leads to, at most that of the hottest winding that a plan may have.
double allowed_factor(const Motor& motor, double factor) {
  if (!motor.thermal) return factor;
  return std::min(factor,
                  copper_factor(*motor.thermal, motor.thermal->max_winding_C - motor.thermal->ambient_C));
}

/// The states of the legs that a plan leads to: the least charge on each of them, the mean resistance.
std::vector<LegState> states_after(const Plan& plan, const Robot& robot, std::vector<LegState> states) {
  if (plan.battery)
    for (std::size_t k = 0; k < plan.battery->least_fraction_on_leg.size(); ++k)
      states[k].open_circuit_voltage_V = voltage_at_V(robot, plan.battery->least_fraction_on_leg[k]);
  if (plan.winding)
    for (std::size_t k = 0; k < plan.winding->resistance_factor_on_leg.size(); ++k)
      for (const Side side : kSides)
        states[k].resistance_factor[side] =
            allowed_factor(robot.motor[side], plan.winding->resistance_factor_on_leg[k][side]);
  return states;
}

bool same(const LegState& a, const LegState& b) {
  const auto near = [](double x, double y, double share) { return x == y || std::abs(x - y) < share * y; };
  return near(a.open_circuit_voltage_V, b.open_circuit_voltage_V, kSameVoltage) &&
         near(a.resistance_factor.left, b.resistance_factor.left, kSameResistance) &&
         near(a.resistance_factor.right, b.resistance_factor.right, kSameResistance);
}

bool is_emptied(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == "battery_reserve";
}

bool may_lack_charge(const std::string& constraint) {
  for (const char* name : {"battery_voltage", "battery_power", "battery_reserve", "deadline", "duration"})
    if (constraint == name) return true;
  return false;
}

}  // namespace

LegState hardest(const std::vector<LegState>& states) {
  LegState worst;
  for (const LegState& state : states) {
    worst.open_circuit_voltage_V = std::min(worst.open_circuit_voltage_V, state.open_circuit_voltage_V);
    for (const Side side : kSides)
      worst.resistance_factor[side] = std::max(worst.resistance_factor[side], state.resistance_factor[side]);
  }
  return worst;
}

namespace {

/// The states that the first plan assumes: cold windings, and no leg has drawn anything; a charger's stop
/// fills the battery.
std::vector<LegState> first_states(double price_of_heat, const MissionRequest& mission, const Robot& robot) {
  double fraction = mission.start.battery_fraction.value_or(1.0);
  std::vector<LegState> states;
  for (const LegRequest& leg : mission.legs) {
    states.push_back(
        {.open_circuit_voltage_V = voltage_at_V(robot, fraction), .price_of_heat = price_of_heat});
    const auto station = mission.stations.find(leg.to);
    if (mission.charging && station != mission.stations.end() && station->second.charger_W > 0)
      fraction = std::max(fraction, mission.charging->to_fraction);
  }
  return states;
}

/// Plans anew until the states stay. Where they do not stay soon, each leg keeps the hardest of its states,
/// so that they can only move one way.
Plan settled_at(double price_of_heat, const MissionRequest& mission, const Robot& robot,
                const PlanInStates& plan_in) {
  std::vector<LegState> states = first_states(price_of_heat, mission, robot);
  for (int round = 1;; ++round) {
    Plan plan = plan_in(states);
    if (is_emptied(plan)) return plan;  // at lower voltages it takes no less
    std::vector<LegState> next = states_after(plan, robot, states);
    if (round > kFreeRounds)
      for (std::size_t k = 0; k < next.size(); ++k) {
        const double price = next[k].price_of_heat;
        next[k] = hardest({states[k], next[k]});
        next[k].price_of_heat = price;
      }
    if (round == kDriftRounds || std::equal(states.begin(), states.end(), next.begin(), same)) return plan;
    states = std::move(next);
  }
}

bool drives_within_limits(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

bool is_too_hot(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == "winding_temperature";
}

}  // namespace

Plan settled_plan(const MissionRequest& mission, const Robot& robot, const PlanInStates& plan_in) {
  constexpr double kFirstPrice = 0.02, kFactor = 3, kMostPrice = 43.74, kClose = 1.2;
  const auto at = [&](double price) { return settled_at(price, mission, robot, plan_in); };
  Plan plan = at(0);
  if (!is_too_hot(plan) || mission.objective.minimize == Objective::Minimize::time) return plan;
  if (is_too_hot(at(kMostPrice))) return plan;
  double bad = 0, good = kFirstPrice;
  Plan cool = at(good);
  while (!drives_within_limits(cool) && good < kMostPrice) bad = good, good *= kFactor, cool = at(good);
  if (!drives_within_limits(cool)) return plan;
  while (bad > 0 && good > kClose * bad) {
    const double middle = std::sqrt(bad * good);
    Plan between = at(middle);
    if (drives_within_limits(between))
      good = middle, cool = std::move(between);
    else
      bad = middle;
  }
  return cool;
}

bool offer_charge(Plan& plan, const Robot& robot, double start_fraction, const PlansWithFraction& plans) {
  if (robot.battery.open_circuit_curve.empty() || !plan.infeasibility || start_fraction >= 1) return false;
  Infeasibility& verdict = plan.infeasibility->reason;
  if (!may_lack_charge(verdict.constraint) || !plans(1.0)) return false;
  int bad = static_cast<int>(std::floor(start_fraction * kHundred)), good = kHundred;
  while (good > bad + 1) {
    const int middle = (good + bad) / 2;
    (plans(static_cast<double>(middle) / kHundred) ? good : bad) = middle;
  }
  const std::string told = sentence(verdict);
  if (verdict.constraint.starts_with("battery_")) verdict.relaxation.clear();
  verdict.relaxation["battery_fraction"] = static_cast<double>(good) / kHundred;
  tell_anew(plan, told);
  return true;
}

void offer_capacity(Plan& plan, const Robot& robot, const PlansWithCapacity& plans) {
  constexpr int kTrials = 40;
  constexpr double kMore = 1.02, kRounding = 1e-6;
  if (robot.battery.open_circuit_curve.empty() || !plan.infeasibility || !plan.battery) return;
  Infeasibility& verdict = plan.infeasibility->reason;
  if (verdict.constraint != "battery_reserve" || !verdict.relaxation.empty()) return;
  const BatteryAccount& account = *plan.battery;
  const double lowest =
      *std::min_element(account.least_fraction_on_leg.begin(), account.least_fraction_on_leg.end());
  const double usable =
      energy_share_between(robot.battery, robot.battery.reserve_fraction, account.start_fraction);
  if (!(usable > 0)) return;
  const double more = energy_share_between(robot.battery, lowest, account.start_fraction) / usable;
  double capacity_Wh = robot.battery.capacity_Wh * std::max(1.0, more) * (1 + kRounding);
  for (int trial = 0; trial < kTrials; ++trial, capacity_Wh *= kMore)
    if (plans(capacity_Wh)) {
      verdict.relaxation["capacity_Wh"] = capacity_Wh;
      return;
    }
}

namespace {

MissionRequest with_dwell(MissionRequest mission, double dwell_s) {
  for (LegRequest& leg : mission.legs)
    if (leg.end_speed_m_s == 0) leg.dwell_s = std::max(leg.dwell_s, dwell_s);
  for (VisitRequest& visit : mission.visit) visit.dwell_s = std::max(visit.dwell_s, dwell_s);
  return mission;
}

MissionRequest with_payload(MissionRequest mission, double share) {
  for (LegRequest& leg : mission.legs) leg.payload.from_kg *= share, leg.payload.to_kg *= share;
  for (VisitRequest& visit : mission.visit) visit.payload_kg *= share;
  return mission;
}

/// The least whole number in (low, high] that works, where high does and larger ones do as well.
int least_that_works(int low, int high, const std::function<bool(int)>& works) {
  constexpr double kClose = 1.1;
  while (high > low + 1 && high > kClose * low) {
    const int middle = (low + high) / 2;
    (works(middle) ? high : low) = middle;
  }
  return high;
}

/// Seconds at every stop with which a mission is planned; 0: none that was tried.
int enough_dwell_s(const MissionRequest& mission, const PlansMission& plans) {
  constexpr int kFirst_s = 4, kMost_s = 4096;
  const auto works = [&](int dwell_s) { return plans(with_dwell(mission, dwell_s)); };
  for (int dwell_s = kFirst_s; dwell_s <= kMost_s; dwell_s *= 4)
    if (works(dwell_s)) return least_that_works(dwell_s == kFirst_s ? 0 : dwell_s / 4, dwell_s, works);
  return 0;
}

/// Percent of every payload that must go; 0: none, or too little even without payload.
int enough_unloaded_percent(const MissionRequest& mission, const PlansMission& plans) {
  constexpr int kStep = 5;
  const auto works = [&](int steps) { return plans(with_payload(mission, 1 - 0.01 * kStep * steps)); };
  if (!works(kHundred / kStep)) return 0;
  return kStep * least_that_works(0, kHundred / kStep, works);
}

double greatest_payload_kg(const MissionRequest& mission) {
  double most_kg = 0;
  for (const LegRequest& leg : mission.legs)
    most_kg = std::max({most_kg, leg.payload.from_kg, leg.payload.to_kg});
  for (const VisitRequest& visit : mission.visit) most_kg = std::max(most_kg, visit.payload_kg);
  return most_kg;
}

}  // namespace

void offer_cooling(Plan& plan, const MissionRequest& mission, const PlansMission& plans) {
  if (!is_too_hot(plan)) return;
  Infeasibility& verdict = plan.infeasibility->reason;
  std::string offers;
  if (const int dwell_s = enough_dwell_s(mission, plans); dwell_s > 0) {
    verdict.relaxation["dwell_s"] = dwell_s;
    offers = "a dwell of " + std::to_string(dwell_s) + " s at every stop";
  }
  const double payload_kg = greatest_payload_kg(mission);
  if (payload_kg > 0)
    if (const int percent = enough_unloaded_percent(mission, plans); percent > 0) {
      verdict.relaxation["payload_kg"] = payload_kg * (1 - 0.01 * percent);
      offers += (offers.empty() ? "" : ", or ") + std::to_string(percent) + " % less of every payload";
    }
  verdict.message +=
      offers.empty() ? "; neither a dwell nor less payload that was tried is enough" : "; enough: " + offers;
  plan.message = verdict.message;
}

}  // namespace joulepath
