#include "planner/mission/charging.hpp"

#include <algorithm>
#include <cmath>

#include "model/watt_hours.hpp"
// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

constexpr int kMostStops = 12;
constexpr int kMostPlans = 60;  ///< tried; a search without a limit grows with the power of the stops
/// A stop is tried before the leg that fails and before this many legs ahead of it; the cheapest of these is
/// taken. Only where none of them helps, it is tried farther ahead.
constexpr std::size_t kEarlierLegs = 2;
constexpr double kDetourShare = 1.3;  ///< of the straight line, in the estimate of the energy to a charger

bool touches_reserve(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == "battery_reserve";
}

bool between_stations(const LegRequest& leg) { return !leg.to.empty() && !leg.path && !leg.motion; }

/// Energy from the start of a leg to a charger, by the failed plan's joules per metre.
double energy_to_J(const MissionRequest& mission, const Plan& failed, const Plant& plant, std::size_t leg,
                   const Station& charger) {
  Pose here = mission.start.pose;
  if (leg > 0) {
    const Station& stop = mission.stations.at(mission.legs[leg - 1].to);
    here = {stop.x_m, stop.y_m, 0.0};
  }
  double energy_J = 0.0, distance_m = 0.0;
  for (const LegPlan& planned : failed.legs) {
    energy_J += planned.energy.total_J() - plant.robot.power.standby_W * planned.dwell_s;
    distance_m += planned.distance_m;
  }
  const double way_m = kDetourShare * std::hypot(charger.x_m - here.x_m, charger.y_m - here.y_m);
  return distance_m > 0 ? energy_J / distance_m * way_m : 0.0;
}

/// Charging time if the robot drives to a charger before a leg; infinite if the charger is too weak.
double charging_s(const MissionRequest& mission, const Plan& failed, const Plant& plant, std::size_t leg,
                  const Station& charger) {
  const Battery& battery = plant.robot.battery;
  const BatteryAccount& account = *failed.battery;
  const double before = leg == 0 ? account.start_fraction : account.fraction_after_leg[leg - 1];
  const double missing_J = (mission.charging->to_fraction - before) * kJoulesPerWh * battery.capacity_Wh +
                           energy_to_J(mission, failed, plant, leg, charger);
  const double power_W = charger.charger_W - plant.robot.power.standby_W;
  const double stored_W = power_W - battery_load(battery, -power_W).loss_W;
  return stored_W > 0 ? std::max(0.0, missing_J) / stored_W : kNoLimit;
}

MissionRequest with_stop(const MissionRequest& mission, std::size_t leg, const std::string& charger,
                         double dwell_s) {
  MissionRequest longer = mission;
  const double payload_kg = mission.legs[leg].payload.from_kg;
  longer.legs.insert(longer.legs.begin() + static_cast<std::ptrdiff_t>(leg),
                     {.to = charger,
                      .payload = {payload_kg, payload_kg},
                      .dwell_s = dwell_s,
                      .charges = true,
                      .marks = mission.charging->marks});
  for (SpeedZone& zone : longer.speed_zones)
    if (zone.leg >= leg) ++zone.leg;
  return longer;
}

/// Missions with one more stop, before one of the legs first..last.
std::vector<MissionRequest> with_one_more_stop(const MissionRequest& mission, const Plan& failed,
                                               const Plant& plant, std::size_t first, std::size_t last) {
  std::vector<MissionRequest> missions;
  for (std::size_t leg = last + 1; leg-- > first;) {
    const bool stands_at_station = leg == 0 || between_stations(mission.legs[leg - 1]);
    const bool charged_already = leg > 0 && mission.legs[leg - 1].charges;
    if (!stands_at_station || charged_already || !between_stations(mission.legs[leg])) continue;
    for (const std::string& charger : mission.charging->stations) {
      const double dwell_s = charging_s(mission, failed, plant, leg, mission.stations.at(charger));
      if (std::isfinite(dwell_s)) missions.push_back(with_stop(mission, leg, charger, dwell_s));
    }
  }
  return missions;
}

struct Attempt {
  MissionRequest mission{};
  Plan plan{};
};

bool drives(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

/// The quality of an attempt: without a breach, less energy is better; else a later breach is better.
std::pair<bool, double> rank(const Plan& plan) {
  return touches_reserve(plan) ? std::pair(false, static_cast<double>(*plan.battery->fails_on_leg))
                               : std::pair(true, -plan.energy.total_J());
}

/// Adds stops until the battery suffices, and goes back where that leads nowhere.
class StopSearch {
 public:
  StopSearch(const Plant& plant, const PlanLegs& plan_legs) : plant_(plant), plan_legs_(plan_legs) {}

  /// A plan with more stops than `from`; nothing where none is found.
  std::optional<Plan> beyond(const Attempt& from, int stops) {
    if (stops == kMostStops) return std::nullopt;
    const std::size_t fails = *from.plan.battery->fails_on_leg;
    const std::size_t near = fails - std::min(fails, kEarlierLegs);
    if (auto plan = best_of(from, near, fails, stops)) return plan;
    for (std::size_t leg = near; leg-- > 0;)
      if (auto plan = best_of(from, leg, leg, stops)) return plan;
    return std::nullopt;
  }

 private:
  /// The best plan with a stop before one of these legs, or with more stops where one alone is not enough.
  std::optional<Plan> best_of(const Attempt& from, std::size_t first, std::size_t last, int stops) {
    std::vector<Attempt> attempts;
    std::vector<MissionRequest> candidates = with_one_more_stop(from.mission, from.plan, plant_, first, last);
    if (!budget_) budget_ = kMostStops * static_cast<int>(candidates.size()) + kMostPlans;
    for (MissionRequest& longer : candidates) {
      if ((*budget_)-- <= 0) break;
      Plan plan = plan_legs_(longer);
      // The inserted stop increases the indices of the legs by one; only a breach beyond that is progress.
      const bool further =
          touches_reserve(plan) && *plan.battery->fails_on_leg > *from.plan.battery->fails_on_leg + 1;
      if (drives(plan) || further) attempts.push_back({std::move(longer), std::move(plan)});
    }
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return rank(a.plan) > rank(b.plan); });
    for (Attempt& attempt : attempts) {
      if (drives(attempt.plan)) return std::move(attempt.plan);
      if (auto plan = beyond(attempt, stops + 1)) return plan;
    }
    return std::nullopt;
  }

  const Plant& plant_;
  const PlanLegs& plan_legs_;
  std::optional<int> budget_{};  ///< plans: one descent to the most stops, and kMostPlans beside it
};

}  // namespace

Plan charge_on_the_way(Plan failed, const MissionRequest& mission, const Plant& plant,
                       const PlanLegs& plan_legs) {
  if (!mission.charging || !touches_reserve(failed)) return failed;
  if (auto plan = StopSearch(plant, plan_legs).beyond({mission, failed}, 0)) return *std::move(plan);
  failed.message = failed.infeasibility->reason.message += "; no charging stop that was tried prevents it";
  return failed;
}

}  // namespace joulepath
