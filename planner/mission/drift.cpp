#include "planner/mission/drift.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

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
std::vector<LegState> first_states(const MissionRequest& mission, const Robot& robot) {
  double fraction = mission.start.battery_fraction.value_or(1.0);
  std::vector<LegState> states;
  for (const LegRequest& leg : mission.legs) {
    states.push_back({.open_circuit_voltage_V = voltage_at_V(robot, fraction)});
    const auto station = mission.stations.find(leg.to);
    if (mission.charging && station != mission.stations.end() && station->second.charger_W > 0)
      fraction = std::max(fraction, mission.charging->to_fraction);
  }
  return states;
}

/// Both states' hardest values; the price of heat is the first one's.
LegState harder(const LegState& a, const LegState& b) {
  LegState result = hardest({a, b});
  result.price_of_heat = a.price_of_heat;
  return result;
}

/// Half way from one state to another.
LegState between(const LegState& a, const LegState& b) {
  const auto middle = [](double x, double y) { return x == y ? x : 0.5 * (x + y); };
  LegState result = a;
  result.open_circuit_voltage_V = middle(a.open_circuit_voltage_V, b.open_circuit_voltage_V);
  for (const Side side : kSides)
    result.resistance_factor[side] = middle(a.resistance_factor[side], b.resistance_factor[side]);
  return result;
}

std::vector<LegState> each(LegState combine(const LegState&, const LegState&), std::vector<LegState> a,
                           const std::vector<LegState>& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), combine);
  return a;
}

bool is_accounted(const Plan& plan) { return plan.battery || plan.winding; }

Plan with_state(Plan plan, const std::vector<LegState>& states) {
  if (plan.infeasibility && plan.infeasibility->leg < states.size())
    plan.infeasibility->state = states[plan.infeasibility->leg];
  return plan;
}

/// A mission at one price of heat: the plan in its own states, and the one in the easiest states, which
/// bounds it.
struct SettledPlan {
  Plan plan{};
  Plan easiest{};
  std::vector<LegState> states{};  ///< the last ones
};

/// Plans anew until the states stay. Where they do not stay soon, each leg keeps the hardest of its states,
/// so that they can only move one way. A plan that drove too hard may leave too little to the legs behind it:
/// then the states between its own and those that it leads to are tried.
SettledPlan settled_from(std::vector<LegState> states, const Robot& robot, const PlanInStates& plan_in) {
  std::vector<LegState> before;
  SettledPlan result;
  std::optional<Plan> refused;  ///< a verdict of the accounts, should no later plan stand
  for (int round = 1;; ++round) {
    Plan plan = with_state(plan_in(states), states);
    if (round == 1) result.easiest = plan;
    if (!is_accounted(plan)) {
      const bool ends = before.empty() || round >= kDriftRounds;
      if (ends) result.plan = refused ? std::move(*refused) : std::move(plan);
      result.states = states;
      if (ends) return result;
      states = each(between, std::move(states), before);
      continue;
    }
    std::vector<LegState> next = states_after(plan, robot, states);
    if (round > kFreeRounds) next = each(harder, std::move(next), states);
    if (round > kDriftRounds || std::equal(states.begin(), states.end(), next.begin(), same)) {
      result.plan = std::move(plan);
      result.states = std::move(states);
      return result;
    }
    if (plan.infeasibility) refused = std::move(plan);
    before = std::exchange(states, std::move(next));
  }
}

bool drives_within_limits(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

bool is_too_hot(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == "winding_temperature";
}

/// The bound of a leg follows from that of the same path in easier states, at whatever price of time mu:
/// E(T) >= bound(T0) + mu (T0 - T). Nothing where the paths differ, or where the bound is one of time.
double bound_from(const LegPlan& easiest, const LegPlan& leg) {
  constexpr double kSame = 1e-9;
  const bool same_path = std::abs(easiest.distance_m - leg.distance_m) <= kSame &&
                         std::abs(easiest.turned_rad - leg.turned_rad) <= kSame;
  if (!same_path) return std::nan("");
  return easiest.lower_bound_J + easiest.price_of_time_W * (easiest.duration_s - leg.duration_s);
}

/// A plan is bounded by the one in the easiest states, cold windings and undrawn charge: with less resistance
/// each motion needs less, with more voltage more motions are possible.
void bound_by(Plan& plan, const Plan& easiest, double accuracy) {
  if (!drives_within_limits(plan) || std::isnan(plan.gap_percent)) return;
  double bound_J = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    LegPlan& leg = plan.legs[k];
    const double energy_J = leg.energy.total_J();
    leg.lower_bound_J = bound_from(easiest.legs.at(k), leg);
    if (leg.lower_bound_J > energy_J) leg.lower_bound_J = energy_J;  // rounding
    if (!std::isnan(leg.lower_bound_J))
      leg.gap_percent = 100 * (energy_J - leg.lower_bound_J) / std::max(1e-9, std::abs(energy_J));
    bound_J += leg.lower_bound_J;
  }
  const double energy_J = plan.energy.total_J();
  plan.lower_bound_J = bound_J;
  plan.gap_percent = std::isnan(bound_J)
                         ? 100 * (1 - (1 - 0.01 * easiest.gap_percent) * easiest.duration_s / plan.duration_s)
                         : 100 * (energy_J - bound_J) / std::max(1e-9, std::abs(energy_J));
  plan.status = plan.gap_percent <= 100 * accuracy ? SolveStatus::optimal : SolveStatus::feasible;
}

/// The least price of heat, to kClose, or any price, with which a mission keeps its temperatures; nothing
/// where no price that was tried does.
std::optional<Plan> cool_plan(const std::function<Plan(double)>& at, bool any_price) {
  constexpr double kLeastPrice = 0.02, kMostPrice = 45, kFactor = 9, kClose = 1.5;
  double good = kMostPrice, bad = kLeastPrice;
  Plan cool = at(good);
  for (; !drives_within_limits(cool); cool = at(good))
    if (is_too_hot(cool) || (good /= kFactor) < kLeastPrice) return std::nullopt;
  while (!any_price && good > kClose * bad) {
    const double middle = std::sqrt(bad * good);
    Plan between = at(middle);
    if (drives_within_limits(between))
      good = middle, cool = std::move(between);
    else
      bad = middle;
  }
  return cool;
}

}  // namespace

Plan settled_plan(const MissionRequest& mission, const Robot& robot, const PlanOptions& options,
                  const PlanInStates& plan_in) {
  SettledPlan settled = settled_from(first_states(mission, robot), robot, plan_in);
  Plan plan = std::move(settled.plan);
  if (is_too_hot(plan) && mission.objective.minimize != Objective::Minimize::time) {
    const auto at = [&, warm = settled.states](double price) mutable {
      for (LegState& state : warm) state.price_of_heat = price;
      SettledPlan priced = settled_from(std::move(warm), robot, plan_in);
      warm = std::move(priced.states);
      return std::move(priced.plan);
    };
    if (std::optional<Plan> cool = cool_plan(at, options.any_price_of_heat)) plan = std::move(*cool);
  }
  bound_by(plan, settled.easiest, options.accuracy);
  return plan;
}

void offer_charge(Plan& plan, const Robot& robot, double start_fraction, const PlansWithFraction& plans) {
  if (robot.battery.open_circuit_curve.empty() || !plan.infeasibility || start_fraction >= 1) return;
  Infeasibility& verdict = plan.infeasibility->reason;
  if (!may_lack_charge(verdict.constraint) || !plans(1.0)) return;
  int bad = static_cast<int>(std::floor(start_fraction * kHundred)), good = kHundred;
  while (good > bad + 1) {
    const int middle = (good + bad) / 2;
    (plans(static_cast<double>(middle) / kHundred) ? good : bad) = middle;
  }
  const std::string told = sentence(verdict);
  if (verdict.constraint.starts_with("battery_")) verdict.relaxation.clear();
  verdict.relaxation["battery_fraction"] = static_cast<double>(good) / kHundred;
  tell_anew(plan, told);
}

void offer_capacity(Plan& plan, const Robot& robot, const PlansWithCapacity& plans) {
  constexpr int kTrials = 12;
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
