#include "planner/accounts/state_offers.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "model/battery_charge.hpp"
#include "model/limit_table.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr int kHundred = 100;

bool may_lack_charge(const std::string& constraint) {
  for (const char* name : {"battery_voltage", "battery_power", "battery_reserve", "deadline", "duration"})
    if (constraint == name) return true;
  return false;
}

}  // namespace

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
  tell_anew(plan, told, sentence(verdict));
}

void offer_capacity(Plan& plan, const Robot& robot, const PlansWithCapacity& plans) {
  constexpr int kTrials = 12;
  constexpr double kMore = 1.02, kRounding = 1e-6;
  if (robot.battery.open_circuit_curve.empty() || !plan.infeasibility || !plan.battery) return;
  Infeasibility& verdict = plan.infeasibility->reason;
  if (verdict.constraint != "battery_reserve" || !verdict.relaxation.empty()) return;
  const BatteryAccount& account = *plan.battery;
  const double usable =
      energy_share_between(robot.battery, robot.battery.reserve_fraction, account.start_fraction);
  if (!(usable > 0)) return;
  const double more =
      energy_share_between(robot.battery, least_fraction(account), account.start_fraction) / usable;
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

std::string cooling_text(const Infeasibility& verdict, double payload_kg) {
  std::ostringstream text;
  text.precision(4);
  const auto dwell = verdict.relaxation.find("dwell_s"), payload = verdict.relaxation.find("payload_kg");
  if (dwell != verdict.relaxation.end()) text << "a dwell of " << dwell->second << " s at every stop";
  if (payload != verdict.relaxation.end())
    text << (text.str().empty() ? "" : ", or ") << kHundred * (1 - payload->second / payload_kg)
         << " % less of every payload";
  return text.str().empty() ? "; neither a dwell nor less payload that was tried is enough"
                            : "; enough: " + text.str();
}

}  // namespace

void offer_cooling(Plan& plan, const MissionRequest& mission, const PlansMission& plans) {
  if (!is_too_hot(plan)) return;
  Infeasibility& verdict = plan.infeasibility->reason;
  if (const int dwell_s = enough_dwell_s(mission, plans); dwell_s > 0)
    verdict.relaxation["dwell_s"] = dwell_s;
  const double payload_kg = greatest_payload_kg(mission);
  if (payload_kg > 0)
    if (const int percent = enough_unloaded_percent(mission, plans); percent > 0)
      verdict.relaxation["payload_kg"] = payload_kg * (1 - 0.01 * percent);
  plan.message = verdict.message += cooling_text(verdict, payload_kg);
}

std::string offers_text(const Infeasibility& verdict, const MissionRequest& mission) {
  return verdict.constraint == kWindingTemperature ? cooling_text(verdict, greatest_payload_kg(mission))
                                                   : sentence(verdict);
}

namespace {

/// The field of a robot's battery that a verdict offers under a key; null: none.
double Battery::*battery_field(const std::string& key) {
  if (key == "capacity_Wh") return &Battery::capacity_Wh;
  if (key == "internal_resistance_ohm") return &Battery::internal_resistance_ohm;
  return key == "max_charge_current_A" ? &Battery::max_charge_current_A : nullptr;
}

/// Null: none.
const Limit* limit_of_key(const std::string& key) {
  const auto row =
      std::find_if(kLimits.begin(), kLimits.end(), [&](const Limit& limit) { return limit.key == key; });
  return row == kLimits.end() ? nullptr : &*row;
}

/// A limit of rows by payload is raised in each that is below.
void set_limit(Robot& robot, const Limit& row, double value) {
  if (row.field != nullptr && robot.limits) (*robot.limits).*row.field = value;
  for (PayloadLimits& loaded : robot.limits_by_payload)
    if (const auto at = loaded.limit_by_key.find(std::string(row.key)); at != loaded.limit_by_key.end())
      at->second = std::max(at->second, value);
  for (const Side side : kSides)
    if (row.field == nullptr) robot.motor[side].*row.rating = value;
}

}  // namespace

bool take_offer(const std::string& key, double value, MissionRequest& mission, Robot& robot) {
  if (const Limit* row = limit_of_key(key))
    set_limit(robot, *row, value);
  else if (key == "battery_fraction")
    mission.start.battery_fraction = value;
  else if (key == "dwell_s")
    mission = with_dwell(std::move(mission), value);
  else if (key == "payload_kg")
    mission = with_payload(mission, value / greatest_payload_kg(mission));
  else if (double Battery::*const field = battery_field(key))
    robot.battery.*field = value;
  else
    return false;
  return true;
}

namespace {

/// Gives a mission a later time where a leg is late; false where it has no such time.
bool take_time(const std::string& key, double value, const PlanInfeasibility& verdict,
               MissionRequest& mission) {
  constexpr double kSame_s = 1e-6;
  if (mission.charging || verdict.leg >= mission.legs.size()) return false;
  LegRequest& leg = mission.legs[verdict.leg];
  std::optional<double>& of_mission = mission.objective.deadline_s;
  const bool whole = of_mission && std::abs(value - verdict.reason.amount - *of_mission) < kSame_s;
  std::optional<double>& time = key == "duration_s" ? leg.duration_s : whole ? of_mission : leg.deadline_s;
  if (!time || !(key == "duration_s" || key == "deadline_s")) return false;
  time = value;
  return true;
}

/// Whether an offer changes a limit or a time and can be taken.
bool take_limit_or_time(const std::string& key, double value, const PlanInfeasibility& verdict,
                        MissionRequest& mission, Robot& robot) {
  const Limit* row = limit_of_key(key);
  if (!row) return take_time(key, value, verdict, mission);
  if (!row->in_limits || row->name == "battery_power") return false;
  return take_offer(key, value, mission, robot);
}

/// A value with which a mission is planned, from the one that its verdict offers; nothing where none is
/// found.
std::optional<double> proven(const std::string& key, double value, const PlanInfeasibility& verdict,
                             const MissionRequest& mission, const Robot& robot, const PlanWith& plan_with) {
  constexpr int kTrials = 5;
  for (int trial = 0; trial < kTrials; ++trial) {
    MissionRequest changed = mission;
    Robot other = robot;
    if (!take_limit_or_time(key, value, verdict, changed, other)) return value;
    const Plan plan = plan_with(changed, other);
    if (!plan.infeasibility) return is_driven(plan) ? std::optional(value) : std::nullopt;
    const auto& more = plan.infeasibility->reason.relaxation;
    const auto at = more.find(key);
    const bool same_time = key.ends_with("_s") && plan.infeasibility->leg != verdict.leg;
    if (at == more.end() || same_time || !(at->second > value)) return std::nullopt;
    value = at->second;
  }
  return std::nullopt;
}

}  // namespace

void prove_offers(Plan& plan, const MissionRequest& mission, const Robot& robot, const PlanWith& plan_with) {
  if (!plan.infeasibility) return;
  Infeasibility& reason = plan.infeasibility->reason;
  const std::string told = offers_text(reason, mission);
  const PlanInfeasibility verdict = *plan.infeasibility;
  for (const auto& [key, value] : verdict.reason.relaxation)
    if (const auto enough = proven(key, value, verdict, mission, robot, plan_with))
      reason.relaxation[key] = *enough;
    else
      reason.relaxation.erase(key);
  tell_anew(plan, told, offers_text(reason, mission));
}

}  // namespace joulepath
