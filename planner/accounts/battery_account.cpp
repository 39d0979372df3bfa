#include "planner/accounts/battery_account.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "model/battery_charge.hpp"
#include "model/battery_power.hpp"
#include "model/limit_table.hpp"
#include "model/normal_quantiles.hpp"
#include "model/nuisance_correlation.hpp"
#include "model/watt_hours.hpp"
#include "planner/accounts/charge.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

struct LegLoss {
  double loss_J{};
  double lowest_voltage_V{kNoLimit};
};

LegLoss loss_on(const LegPlan& leg, const Plant& nominal) {
  const Plant plant = plant_in(nominal, leg.state);
  LegLoss loss;
  for (const StretchPlan& stretch : leg.stretches) {
    loss.loss_J += stretch.battery_loss_J;
    loss.lowest_voltage_V = std::min(loss.lowest_voltage_V, stretch.lowest_voltage_V);
  }
  if (leg.prescribed) {
    EnergySum sum(plant);
    LegMotion(leg, plant).integrate([&](const EnergyNode& node, double) { sum.add(node); });
    loss = {sum.battery_loss_J(), sum.lowest_voltage_V()};
  }
  const double standby_W = plant.robot.power.standby_W, rest_s = resting_s(leg, standby_W);
  if (rest_s == 0) return loss;
  const BatteryLoad load = battery_load(plant.robot.battery, standby_W);
  loss.loss_J += load.loss_W * rest_s;
  loss.lowest_voltage_V = std::min(loss.lowest_voltage_V, load.terminal_voltage_V);
  return loss;
}

/// Change of a planned leg's energy when an uncertain constant is one sigma higher: half the difference
/// between one sigma more and one less.
double sigma_shift_J(const LegPlan& leg, const UncertainPlant& plant, std::size_t constant) {
  const auto& [more, less] = plant.shifted[constant];
  const double still_s = leg.prescribed ? leg.dwell_s : leg.duration_s + leg.dwell_s;
  double shift_J = 0.5 * still_s * (more.robot.power.standby_W - less.robot.power.standby_W);
  for (const StretchPlan& stretch : leg.stretches) shift_J += stretch.sigma_shift_J[constant];
  if (leg.prescribed)
    shift_J += 0.5 * (prescribed_energy(leg, more).total_J() - prescribed_energy(leg, less).total_J());
  return shift_J;
}

/// How far (V) the open-circuit voltage on a leg is from the one that its motion was planned with, between
/// the greatest and the least state of charge there.
double voltage_error_V(const Battery& battery, const LegState& state, double most, double least) {
  return std::max(std::abs(open_circuit_voltage_V(battery, most) - state.open_circuit_voltage_V),
                  std::abs(open_circuit_voltage_V(battery, least) - state.open_circuit_voltage_V));
}

}  // namespace

double variance_of(const std::vector<double>& shifts, double of_model, const Eigen::MatrixXd& correlation) {
  double sum = of_model * of_model;
  for (const double shift : shifts) sum += shift * shift;
  return std::max(0.0, sum + correlated_variance(shifts, correlation));
}

double fed_W(const LegPlan& leg, double standby_W) { return std::min(leg.charger_W, standby_W); }

double resting_s(const LegPlan& leg, double standby_W) {
  double rest_s = leg.charger_W < standby_W ? leg.dwell_s : 0.0;
  for (const StretchPlan& stretch : leg.stretches) rest_s += stretch.profile.wait_s;
  return leg.stretches.empty() && !leg.prescribed ? rest_s + leg.duration_s : rest_s;
}

void find_energy_sigmas(Plan& plan, const UncertainPlant& plant) {
  const Eigen::MatrixXd correlation = nuisance_correlation(plant.plant.robot);
  const std::optional<double> of_model = plant.plant.robot.model_energy_sigma();
  std::vector<double> shifts_J(plant.shifted.size(), 0.0), leg_variances_J2;
  double of_model_J = 0.0;
  for (const LegPlan& leg : plan.legs) {
    std::vector<double> of_leg_J;
    for (std::size_t i = 0; i < shifts_J.size(); ++i) {
      of_leg_J.push_back(sigma_shift_J(leg, plant, i));
      shifts_J[i] += of_leg_J[i];
    }
    const double leg_model_J = of_model.value_or(0) * leg.energy.motion_J();
    of_model_J += leg_model_J;
    leg_variances_J2.push_back(variance_of(of_leg_J, leg_model_J, correlation));
  }
  const double whole_J2 = variance_of(shifts_J, of_model_J, correlation);
  if (whole_J2 <= 0) return;
  plan.sigma_has_model_error = of_model.has_value();
  plan.energy_sigma_J = std::sqrt(whole_J2);
  for (std::size_t k = 0; k < plan.legs.size(); ++k)
    plan.legs[k].energy_sigma_J = std::sqrt(leg_variances_J2[k]);
}

std::optional<BatteryAccount> battery_account(Plan& plan, const UncertainPlant& uncertain,
                                              double start_fraction, double charge_to_fraction) {
  find_energy_sigmas(plan, uncertain);
  const Plant& plant = uncertain.plant;
  const Battery& battery = plant.robot.battery;
  if (!std::isfinite(battery.capacity_Wh)) return std::nullopt;
  const double standby_W = plant.robot.power.standby_W;
  Charge charge(battery, start_fraction);
  BatteryAccount account{.start_fraction = start_fraction,
                         .lowest_voltage_V = open_circuit_voltage_V(battery, start_fraction)};
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    LegPlan& leg = plan.legs[k];
    const LegLoss loss = loss_on(leg, plant);
    account.loss_J += loss.loss_J;
    account.lowest_voltage_V = std::min(account.lowest_voltage_V, loss.lowest_voltage_V);
    const double before = charge.fraction();
    charge.draw(leg.energy.total_J() + loss.loss_J - fed_W(leg, standby_W) * leg.dwell_s);
    const auto [least, most] = std::minmax({before, charge.fraction()});
    account.least_fraction_on_leg.push_back(least);
    if (!battery.open_circuit_curve.empty())
      account.voltage_error_V =
          std::max(account.voltage_error_V.value_or(0.0), voltage_error_V(battery, leg.state, most, least));
    if (!account.fails_on_leg && charge.fraction() < battery.reserve_fraction) account.fails_on_leg = k;
    if (leg.charger_W > standby_W)
      leg.charged_J = charge.take_up(leg.charger_W - standby_W, leg.dwell_s, charge_to_fraction);
    account.charged_J += leg.charged_J;
    account.fraction_after_leg.push_back(charge.fraction());
  }
  account.end_fraction = charge.fraction();
  if (plan.energy_sigma_J) {
    const double half_width_J = kNormal95 * *plan.energy_sigma_J;
    account.interval_95 = {fraction_after(battery, account.end_fraction, half_width_J),
                           std::min(1.0, fraction_after(battery, account.end_fraction, -half_width_J))};
  }
  // A bound without the model's own error is none.
  const double margin_J =
      plan.sigma_has_model_error ? kNormal95OneSided * plan.energy_sigma_J.value_or(0.0) : 0.0;
  account.required_capacity_Wh = (charge.peak_J() + margin_J) / kJoulesPerWh;
  const double usable_Wh = battery.capacity_Wh * energy_share_between(battery, battery.reserve_fraction, 1.0);
  account.missions_per_charge =
      account.required_capacity_Wh > 0 ? std::floor(usable_Wh / account.required_capacity_Wh) : kNoLimit;
  return account;
}

double least_fraction(const BatteryAccount& account) {
  return *std::min_element(account.least_fraction_on_leg.begin(), account.least_fraction_on_leg.end());
}

namespace {

/// The state of charge at the start, or the capacity, with which a plan keeps the reserve; nothing where
/// neither alone does. The plan's energy does not depend on them.
std::map<std::string, double> enough_charge(const BatteryAccount& account, const Battery& battery) {
  constexpr double kRounding = 1e-9;
  if (!battery.open_circuit_curve.empty()) return {};  // then it does: offer_charge() plans anew
  const double lowest = least_fraction(account);
  const double start = account.start_fraction + (battery.reserve_fraction - lowest) * (1 + kRounding);
  if (start <= 1) return {{"battery_fraction", start}};
  const double usable = account.start_fraction - battery.reserve_fraction;
  if (!(usable > 0)) return {};
  return {
      {"capacity_Wh", battery.capacity_Wh * (account.start_fraction - lowest) / usable * (1 + kRounding)}};
}

std::string reserve_margin_text(const Battery& battery) {
  std::ostringstream text;
  text.precision(4);
  if (battery.reserve_margin > 0)
    text << " and a margin of " << 100 * battery.reserve_margin << " % of the capacity";
  return text.str();
}

}  // namespace

std::optional<Infeasibility> battery_too_weak(const Robot& robot, const Pose& pose) {
  const double standby_W = robot.power.standby_W, most_W = planned_battery_power_W(robot.battery);
  if (standby_W <= most_W) return std::nullopt;
  Infeasibility verdict{.constraint = "battery_power",
                        .x_m = pose.x_m,
                        .y_m = pose.y_m,
                        .amount = standby_W - most_W,
                        .unit = "W",
                        .relaxation = {{"battery_power_W", standby_W}}};
  verdict.message = sentence(verdict);
  return verdict;
}

namespace {

/// The largest resistance below the robot's with which the mission is planned, to a tenth, from a guess on;
/// nothing where a 256th of that is not enough.
std::optional<double> planned_resistance_ohm(double guess_ohm, const Robot& robot, const PlansBy& plans) {
  constexpr int kHalvings = 8;
  constexpr double kClose = 1.1, kNear = 1.09;  // a guess may be the end of what the battery supplies
  const auto works = [&](double resistance_ohm) {
    Robot other = robot;
    other.battery.internal_resistance_ohm = resistance_ohm;
    return plans(other);
  };
  double works_ohm = guess_ohm, fails_ohm = robot.battery.internal_resistance_ohm;
  bool found = works(works_ohm);
  if (!found) fails_ohm = works_ohm, works_ohm /= kNear, found = works(works_ohm);
  for (int halvings = 0; !found; ++halvings) {
    if (halvings == kHalvings) return std::nullopt;
    fails_ohm = works_ohm, works_ohm *= 0.5, found = works(works_ohm);
  }
  while (fails_ohm > kClose * works_ohm) {
    const double between_ohm = std::sqrt(works_ohm * fails_ohm);
    (works(between_ohm) ? works_ohm : fails_ohm) = between_ohm;
  }
  return works_ohm;
}

/// The charge current (A) of a power into the terminals at an open-circuit voltage, or one up to 10 % above
/// it, with which the mission is planned.
std::optional<double> planned_charge_current_A(double power_W, const Robot& robot, double open_V,
                                               const PlansBy& plans) {
  constexpr int kTrials = 5;
  constexpr double kMore = 1.02;
  const double R = robot.battery.internal_resistance_ohm;
  double current_A = 2 * power_W / (open_V + std::sqrt(open_V * open_V + 4 * R * power_W));
  for (int trial = 0; trial < kTrials; ++trial, current_A *= kMore) {
    Robot other = robot;
    other.battery.max_charge_current_A = current_A;
    if (plans(other)) return current_A;
  }
  return std::nullopt;
}

}  // namespace

void tell_anew(Plan& plan, const std::string& told, const std::string& now) {
  std::string& message = plan.infeasibility->reason.message;
  if (const auto at = message.find(told); at != std::string::npos) message.replace(at, told.size(), now);
  plan.message = message;
}

void name_battery_keys(Plan& plan, const Robot& robot, const PlansBy& plans) {
  Infeasibility& verdict = plan.infeasibility->reason;
  const std::string told = sentence(verdict);
  const Battery battery = robot_in(robot, plan.infeasibility->state).battery;
  const double ohm = battery.internal_resistance_ohm;
  if (const auto power = verdict.relaxation.find("charge_power_W"); power != verdict.relaxation.end()) {
    const double needed_W = power->second;
    verdict.relaxation.erase(power);
    if (const auto planned = planned_charge_current_A(needed_W, robot, battery.open_circuit_voltage_V, plans))
      verdict.relaxation["max_charge_current_A"] = *planned;
  }
  if (verdict.relaxation.erase("battery_voltage_V") > 0 && ohm > 0)
    if (const auto planned = planned_resistance_ohm(0.5 * ohm, robot, plans))
      verdict.relaxation["internal_resistance_ohm"] = *planned;
  if (const std::string now = sentence(verdict); now != told) tell_anew(plan, told, now);
}

void blame_battery(Plan& plan, const Robot& robot, const PayloadAlongLeg& payload, const PlansBy& plans) {
  Infeasibility& verdict = plan.infeasibility->reason;
  const auto power = verdict.relaxation.find("battery_power_W");
  const double most_W = planned_battery_power_W(robot_in(robot, plan.infeasibility->state).battery);
  const double stated_W = limits_between_payloads(robot, payload.from_kg, payload.to_kg).battery_power_W;
  if (most_W >= stated_W) return;
  const std::string cause = sentence(verdict);
  if (power != verdict.relaxation.end()) {
    const double needed_W = power->second;
    verdict.relaxation.erase(power);
    // Power is inverse to the resistance.
    if (needed_W <= stated_W)
      if (const auto planned =
              planned_resistance_ohm(robot.battery.internal_resistance_ohm * most_W / needed_W, robot, plans))
        verdict.relaxation["internal_resistance_ohm"] = *planned;
  }
  std::ostringstream text;
  text.precision(4);
  text << "the battery supplies at most " << most_W << " W at its terminals; " << sentence(verdict);
  if (verdict.message.rfind(cause, 0) == 0) text << verdict.message.substr(cause.size());
  plan.message = verdict.message = text.str();
}

std::optional<Infeasibility> battery_too_small(const Plan& plan, const Plant& plant) {
  if (!plan.battery || !plan.battery->fails_on_leg) return std::nullopt;
  const BatteryAccount& account = *plan.battery;
  const Battery& battery = plant.robot.battery;
  const Pose& pose = plan.legs[*account.fails_on_leg].start_pose;
  return Infeasibility{
      .constraint = "battery_reserve",
      .x_m = pose.x_m,
      .y_m = pose.y_m,
      .amount = energy_share_between(battery, least_fraction(account), battery.reserve_fraction) *
                battery.capacity_Wh,
      .unit = "Wh",
      .relaxation = enough_charge(account, battery),
      .message = "the battery falls below its reserve" + reserve_margin_text(battery) + " on the way"};
}

}  // namespace joulepath
