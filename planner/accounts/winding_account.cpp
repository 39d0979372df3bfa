#include "planner/accounts/winding_account.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "model/winding.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

/// One winding along a leg.
class Winding {
 public:
  Winding(const Motor& motor, Side side) : motor_(motor), side_(side) {}

  bool is_stated() const { return motor_.thermal.has_value(); }
  double temperature_C() const { return is_stated() ? motor_.thermal->ambient_C + rise_K_ : 0.0; }
  double above_limit_K() const { return temperature_C() - motor_.thermal->max_winding_C; }

  void begin_leg() { loss_ = cold_loss_ = 0, most_C_ = temperature_C(); }
  /// `resistance_factor`: of effects that change the resistance, beside the heat.
  void carry(double current_A, double resistance_factor, double time_s) {
    if (!is_stated()) return;
    const double before = copper_factor(*motor_.thermal, rise_K_);
    const double cold_ohm = resistance_factor * motor_.resistance_ohm;
    rise_K_ = std::min(rise_after_K(*motor_.thermal, cold_ohm, rise_K_, current_A, time_s), runaway_K());
    const double cold_J = cold_ohm * current_A * current_A * time_s;
    cold_loss_ += cold_J;
    loss_ += 0.5 * (before + copper_factor(*motor_.thermal, rise_K_)) * cold_J;
    most_C_ = std::max(most_C_, temperature_C());
  }
  double most_on_leg_C() const { return most_C_; }
  Side side() const { return side_; }

  /// Resistance relative to the cold one: its mean over the leg by copper loss.
  double mean_factor() const {
    if (!is_stated()) return 1.0;
    return cold_loss_ > 0 ? loss_ / cold_loss_ : copper_factor(*motor_.thermal, rise_K_);
  }

 private:
  /// A rise beyond which no more is counted: the winding has been too hot for long.
  double runaway_K() const { return 10 * (motor_.thermal->max_winding_C - motor_.thermal->ambient_C); }

  const Motor& motor_;
  Side side_;
  double rise_K_{};
  double cold_loss_{}, loss_{}, most_C_{};
};

/// Both windings over the legs.
class Heating {
 public:
  /// `trace`: told time and both windings after each node and rest.
  using Trace = std::function<void(double time_s, const std::array<Winding, 2>&)>;
  explicit Heating(const Plant& plant, Trace trace = {})
      : plant_(plant),
        trace_(std::move(trace)),
        windings_{Winding(plant.robot.motor.left, Side::left),
                  Winding(plant.robot.motor.right, Side::right)} {
    look();
  }

  void add(const LegPlan& leg) {
    const Plant here = plant_in(plant_, leg.state);
    const LegMotion motion(leg, here);
    for (Winding& winding : windings_) winding.begin_leg();
    time_s_ = leg.start_s;
    const auto drive = [&](const EnergyNode& node) {
      visit(energy_node(here, node.instant, node.time_s, node.weight_s));
    };
    for (std::size_t k = 0; k < leg.stretches.size(); ++k) {
      const Profile& profile = leg.stretches[k].profile;
      integrate_profile(motion.stretch(k), profile, 0.0, profile.duration_s(), drive);
      rest(profile.wait_s);
    }
    if (motion.prescribed())
      motion.prescribed()->integrate_between(motion.prescribed()->start_s(), motion.prescribed()->end_s(),
                                             drive);
    if (leg.stretches.empty() && !leg.prescribed) rest(leg.duration_s);
    account_.hottest_on_leg_C.push_back(each([](const Winding& w) { return w.most_on_leg_C(); }));
    rest(leg.dwell_s);
    account_.after_leg_C.push_back(each([](const Winding& w) { return w.temperature_C(); }));
    account_.resistance_factor_on_leg.push_back(each([](const Winding& w) { return w.mean_factor(); }));
  }

  WindingAccount account() && { return std::move(account_); }

 private:
  template <class Value>
  Sided<double> each(Value&& value) const {
    return {value(windings_[0]), value(windings_[1])};
  }
  void visit(const EnergyNode& node) {
    const double factor = plant_.resistance_factor(node.instant.site.time_of_day_s);
    for (Winding& winding : windings_)
      winding.carry(node.wheels[winding.side()].current_A, factor, node.weight_s);
    time_s_ += node.weight_s;
    look();
  }
  void rest(double time_s) {
    for (Winding& winding : windings_) winding.carry(0.0, 1.0, time_s);
    time_s_ += time_s;
    if (trace_) trace_(time_s_, windings_);
  }
  void look() {
    if (trace_) trace_(time_s_, windings_);
    for (const Winding& winding : windings_) {
      if (!winding.is_stated()) continue;
      if (winding.temperature_C() > account_.highest_C) {
        account_.highest_C = winding.temperature_C();
        account_.side = winding.side();
      }
      if (winding.above_limit_K() > 0 && !account_.fails_on_leg) {
        account_.fails_on_leg = account_.after_leg_C.size();
        account_.fails_at_s = time_s_;
      }
      account_.above_limit_K = std::max(account_.above_limit_K, winding.above_limit_K());
    }
  }

  const Plant& plant_;
  Trace trace_;
  std::array<Winding, 2> windings_;
  WindingAccount account_{.highest_C = -kNoLimit, .above_limit_K = -kNoLimit};
  double time_s_{};
};

std::string margin_text(const Motor& motor) {
  std::ostringstream text;
  text.precision(4);
  if (motor.thermal->margin_K > 0) text << " less a margin of " << motor.thermal->margin_K << " K";
  return text.str();
}

}  // namespace

std::optional<WindingAccount> winding_account(const Plan& plan, const Plant& plant) {
  if (!plant.robot.motor.left.thermal && !plant.robot.motor.right.thermal) return std::nullopt;
  Heating heating(plant);
  for (const LegPlan& leg : plan.legs) heating.add(leg);
  WindingAccount account = std::move(heating).account();
  for (const LegPlan& leg : plan.legs) {
    account.price_of_heat = std::max(account.price_of_heat, leg.state.price_of_heat);
    const Sided<double>& planned_A = leg.state.planned_current_A;
    if (std::isinf(std::min(planned_A.left, planned_A.right))) continue;
    if (!account.planned_current_A)
      account.planned_current_A =
          map_sides(plant.robot.motor, [](Side, const Motor& motor) { return motor.max_current_A; });
    for (const Side side : kSides)
      (*account.planned_current_A)[side] = std::min((*account.planned_current_A)[side], planned_A[side]);
  }
  return account;
}

std::vector<double> winding_temperatures_C(const Plan& plan, const Plant& plant, Side side,
                                           const std::vector<double>& times_s) {
  std::vector<double> temperatures_C;
  std::optional<std::pair<double, double>> last;  // time and temperature
  Heating heating(plant, [&](double time_s, const std::array<Winding, 2>& windings) {
    const double here_C = windings[side == Side::left ? 0 : 1].temperature_C();
    const auto [before_s, before_C] = last.value_or(std::pair(time_s, here_C));
    for (std::size_t k = temperatures_C.size(); k < times_s.size() && times_s[k] <= time_s; ++k) {
      const double share = time_s > before_s ? (times_s[k] - before_s) / (time_s - before_s) : 1.0;
      temperatures_C.push_back(std::lerp(before_C, here_C, share));
    }
    last = {time_s, here_C};
  });
  for (const LegPlan& leg : plan.legs) heating.add(leg);
  temperatures_C.resize(times_s.size(), last ? last->second : 0.0);
  return temperatures_C;
}

std::optional<Infeasibility> winding_too_hot(const Plan& plan, const Robot& robot) {
  if (!plan.winding || !plan.winding->fails_on_leg) return std::nullopt;
  const WindingAccount& account = *plan.winding;
  const Pose& pose = plan.legs[*account.fails_on_leg].start_pose;
  std::ostringstream text;
  text.precision(4);
  text << "the " << side_name(account.side) << " motor's winding reaches " << account.highest_C << " C, "
       << account.above_limit_K << " K above max_winding_C" << margin_text(robot.motor[account.side])
       << "; the limit is passed on leg "
       << leg_text(*account.fails_on_leg, plan.legs[*account.fails_on_leg].to) << ", " << account.fails_at_s
       << " s after the mission's start";
  return Infeasibility{.constraint = kWindingTemperature,
                       .x_m = pose.x_m,
                       .y_m = pose.y_m,
                       .amount = account.above_limit_K,
                       .unit = "K",
                       .message = text.str()};
}

bool is_too_hot(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == kWindingTemperature;
}

}  // namespace joulepath
