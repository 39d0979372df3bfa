#include "planner/mission/drift.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "model/battery_charge.hpp"
#include "model/winding.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/mission/mission_time.hpp"

namespace joulepath {
namespace {

constexpr int kDriftRounds = 8, kFreeRounds = 4;
constexpr double kSameVoltage = 1e-5, kSameResistance = 5e-4;  ///< relative

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

/// Both states' hardest values; what keeps windings cool is the first one's.
LegState harder(const LegState& a, const LegState& b) {
  LegState result = hardest({a, b});
  result.price_of_heat = a.price_of_heat;
  result.planned_current_A = a.planned_current_A;
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
  if (!is_driven(plan) || std::isnan(plan.gap_percent)) return;
  double bound_J = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    LegPlan& leg = plan.legs[k];
    const double energy_J = leg.energy.total_J();
    leg.lower_bound_J = bound_from(easiest.legs.at(k), leg);
    if (leg.lower_bound_J > energy_J) leg.lower_bound_J = energy_J;  // rounding
    if (!std::isnan(leg.lower_bound_J)) leg.gap_percent = gap_percent(energy_J, leg.lower_bound_J);
    bound_J += leg.lower_bound_J;
  }
  plan.lower_bound_J = bound_J;
  plan.gap_percent = std::isnan(bound_J)
                         ? 100 * (1 - (1 - 0.01 * easiest.gap_percent) * easiest.duration_s / plan.duration_s)
                         : gap_percent(plan.energy.total_J(), bound_J);
  plan.status = plan.gap_percent <= 100 * accuracy ? SolveStatus::optimal : SolveStatus::feasible;
}

/// How far (K) a plan's windings are above their limit; nothing where it is refused for another reason.
std::optional<double> above_limit_K(const Plan& plan) {
  if (plan.winding && (is_driven(plan) || is_too_hot(plan))) return plan.winding->above_limit_K;
  return std::nullopt;
}

/// A range of what keeps windings cool: a price of heat, or how far below their limits currents stay.
struct Cooling {
  double least{}, most{};  ///< the least is too little
  double step{};           ///< factor between trials from the most down, until one can be driven
  double close{};          ///< factor between too little and enough at which the search ends
};

/// A value between two, of which the first is too little: where a line through both temperatures over the
/// logarithms of the values meets the limit, but not close to an end.
double value_between(double bad, std::optional<double> bad_K, double good, std::optional<double> good_K) {
  constexpr double kFromEnd = 0.1;
  const double share = bad_K && good_K && *bad_K > *good_K ? *bad_K / (*bad_K - *good_K) : 0.5;
  return bad * std::pow(good / bad, std::clamp(share, kFromEnd, 1 - kFromEnd));
}

/// The plan with the least value, or within kClose_K of the limit, or with any value, with which a mission
/// keeps its temperatures; the last one that was tried where none does.
Plan cool_plan(const Cooling& range, const std::function<Plan(double)>& at, const Plan& hot, bool any_value) {
  constexpr double kClose_K = 0.1;
  double good = range.most, bad = range.least;
  Plan cool = at(good);
  for (; !is_driven(cool); cool = at(good))
    if (is_too_hot(cool) || (good /= range.step) < range.least) return cool;
  std::optional<double> bad_K = above_limit_K(hot), good_K = above_limit_K(cool);
  while (!any_value && good > range.close * bad && !(good_K && *good_K > -kClose_K)) {
    const double middle = value_between(bad, bad_K, good, good_K);
    Plan between = at(middle);
    const std::optional<double> between_K = above_limit_K(between);
    if (is_driven(between))
      good = middle, good_K = between_K, cool = std::move(between);
    else
      bad = middle, bad_K = between_K;
  }
  return cool;
}

/// The current (A) that a hot winding bears for any time: rise = R_th R (1 + alpha rise) i^2.
double continuous_current_A(const Motor& motor) {
  if (!motor.thermal) return kNoLimit;
  const double rise_K = motor.thermal->max_winding_C - motor.thermal->ambient_C;
  const double hot_ohm = motor.resistance_ohm * copper_factor(*motor.thermal, rise_K);
  return std::sqrt(rise_K / (motor.thermal->resistance_K_W * hot_ohm));
}

/// The greatest current of a motor over the one that it bears for any time.
double overload(const Motor& motor) {
  return std::min(motor.max_current_A, motor.max_voltage_V / motor.resistance_ohm) /
         continuous_current_A(motor);
}

/// Keeps the temperatures of a mission by what its legs are planned with.
class CoolMission {
 public:
  CoolMission(const Robot& robot, const PlanInStates& plan_in, std::vector<LegState> states)
      : robot_(robot), plan_in_(plan_in), states_(std::move(states)) {}

  /// By a price of copper loss, which spreads the heat over a mission.
  Plan by_price(const Plan& hot, bool any_value) const {
    constexpr Cooling kPrices{.least = 0.02, .most = 45, .step = 9, .close = 1.05};
    return cool_plan(kPrices, planner([](LegState& state, double price) { state.price_of_heat = price; }),
                     hot, any_value);
  }

  /// By currents between those that the motors bear for any time and their limits, which lowers the peaks of
  /// windings that heat up within a leg.
  Plan by_current(const Plan& hot, bool any_value) const {
    const double most =
        std::min(kMostOverload, std::max(overload(robot_.motor.left), overload(robot_.motor.right)));
    if (!(most > 1)) return hot;
    const Cooling currents{.least = 1 / most, .most = 1, .step = 2, .close = 1.01};
    const auto limit = [&](LegState& state, double share) {
      for (const Side side : kSides)
        state.planned_current_A[side] = continuous_current_A(robot_.motor[side]) / share;
    };
    return cool_plan(currents, planner(limit), hot, any_value);
  }

 private:
  static constexpr double kMostOverload = 30;

  std::function<Plan(double)> planner(std::function<void(LegState&, double)> set) const {
    return [this, set = std::move(set), warm = states_](double value) mutable {
      for (LegState& state : warm) set(state, value);
      SettledPlan settled = settled_from(std::move(warm), robot_, plan_in_);
      warm = std::move(settled.states);
      return std::move(settled.plan);
    };
  }

  const Robot& robot_;
  const PlanInStates& plan_in_;
  std::vector<LegState> states_;
};

/// The cheaper one of a plan's coolings; the plan itself where there is none. Without time to spare, which
/// any price of heat takes, lower currents do not help either.
Plan cooled(const Plan& hot, const Objective& objective, bool any_value, const CoolMission& mission) {
  const bool timed = objective.minimize == Objective::Minimize::time;
  Plan best = timed ? hot : mission.by_price(hot, any_value);
  if (is_driven(best) ? !any_value : is_too_hot(best)) {
    Plan other = mission.by_current(hot, any_value);
    if (is_driven(other) && (!is_driven(best) || cost(other, objective) < cost(best, objective)))
      best = std::move(other);
  }
  return is_driven(best) ? best : hot;
}

}  // namespace

Plan settled_plan(const MissionRequest& mission, const Robot& robot, const PlanOptions& options,
                  const PlanInStates& plan_in) {
  SettledPlan settled = settled_from(first_states(mission, robot), robot, plan_in);
  Plan plan = std::move(settled.plan);
  if (is_too_hot(plan))
    plan = cooled(plan, mission.objective, options.any_price_of_heat, {robot, plan_in, settled.states});
  bound_by(plan, settled.easiest, options.accuracy);
  return plan;
}

}  // namespace joulepath
