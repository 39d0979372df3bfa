#include "planner/mission/charging.hpp"

#include <algorithm>
#include <cmath>

#include "model/battery_charge.hpp"
#include "model/battery_power.hpp"
#include "model/watt_hours.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/path/geometry/polygon_distance.hpp"
// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

constexpr int kMostStops = 12;
constexpr int kMostPlans = 60;   ///< tried; a search without a limit grows with the power of the stops
constexpr int kMostRefined = 6;  ///< plans with refined paths, where none of the unrefined ones drives
/// A stop is tried before the leg that fails and before this many legs ahead of it, and at so many places
/// farther ahead that the estimate calls cheaper than all of these. Only where none of them helps, it is
/// tried at the others.
constexpr std::size_t kEarlierLegs = 2, kCheapEarlier = 2;
/// A stop whose estimate is this many times that of one that helps is not planned.
constexpr double kDear = 1.3;
/// Of the straight line, in the estimate of energy and time to a charger.
constexpr double kDetourShare = 1.3;

bool touches_reserve(const Plan& plan) {
  return plan.infeasibility && plan.infeasibility->reason.constraint == "battery_reserve";
}

bool between_stations(const LegRequest& leg) { return !leg.to.empty() && !leg.path && !leg.motion; }

struct Driving {
  double energy_J{}, time_s{};
};

/// What a plan takes per metre.
Driving per_metre(const Plan& failed, const Plant& plant) {
  Driving all;
  double driven_m = 0.0;
  for (const LegPlan& planned : failed.legs) {
    all.energy_J += planned.energy.total_J() - plant.robot.power.standby_W * planned.dwell_s;
    all.time_s += planned.duration_s;
    driven_m += planned.distance_m;
  }
  return driven_m > 0 ? Driving{all.energy_J / driven_m, all.time_s / driven_m} : Driving{};
}

/// A way between two stops.
Driving way(const Driving& metre, const Point2& from_m, const Point2& to_m) {
  const double length_m = kDetourShare * distance_m(from_m, to_m);
  return {length_m * metre.energy_J, length_m * metre.time_s};
}

Point2 place_of(const Station& station) { return {station.x_m, station.y_m}; }

/// Where the robot stands before a leg that begins at a station, or at the mission's start.
Point2 place_before(const MissionRequest& mission, std::size_t leg) {
  return leg > 0 ? place_of(mission.stations.at(mission.legs[leg - 1].to))
                 : Point2{mission.start.pose.x_m, mission.start.pose.y_m};
}

/// Charging time if the robot drives to a charger before a leg; infinite if the charger is too weak.
double charging_s(const MissionRequest& mission, const BatteryAccount& account, const Driving& metre,
                  const Plant& plant, std::size_t leg, const Station& charger) {
  const Battery& battery = plant.robot.battery;
  const double before = leg == 0 ? account.start_fraction : account.fraction_after_leg[leg - 1];
  const double missing_J = energy_share_between(battery, before, mission.charging->to_fraction) *
                               kJoulesPerWh * battery.capacity_Wh +
                           way(metre, place_before(mission, leg), place_of(charger)).energy_J;
  const double power_W = charger.charger_W - plant.robot.power.standby_W;
  const double stored_W = stored_power_W(battery, before, power_W);
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

/// A mission with one more stop, and what the stop adds to its cost by estimate.
struct Candidate {
  MissionRequest mission{};
  std::size_t leg{};
  double extra{};
};

/// Missions with one more stop, before one of the legs up to `last`, the latest leg first.
std::vector<Candidate> with_one_more_stop(const MissionRequest& mission, const Plan& failed,
                                          const Plant& plant, std::size_t last) {
  const Driving metre = per_metre(failed, plant);
  std::vector<Candidate> candidates;
  for (std::size_t leg = last + 1; leg-- > 0;) {
    const bool stands_at_station = leg == 0 || between_stations(mission.legs[leg - 1]);
    const bool charged_already = leg > 0 && mission.legs[leg - 1].charges;
    if (!stands_at_station || charged_already || !between_stations(mission.legs[leg])) continue;
    const Point2 here_m = place_before(mission, leg),
                 goal_m = place_of(mission.stations.at(mission.legs[leg].to));
    for (const std::string& name : mission.charging->stations) {
      const Station& charger = mission.stations.at(name);
      const double dwell_s = charging_s(mission, *failed.battery, metre, plant, leg, charger);
      if (!std::isfinite(dwell_s)) continue;
      const Driving there = way(metre, here_m, place_of(charger)), on = way(metre, place_of(charger), goal_m),
                    straight = way(metre, here_m, goal_m);
      const double extra =
          cost(there.energy_J + on.energy_J - straight.energy_J + plant.robot.power.standby_W * dwell_s,
               there.time_s + on.time_s - straight.time_s + dwell_s, mission.objective);
      candidates.push_back({with_stop(mission, leg, name, dwell_s), leg, extra});
    }
  }
  return candidates;
}

bool is_cheaper(const Candidate& a, const Candidate& b) { return a.extra < b.extra; }

/// Takes the candidates out that are tried together: those near the failing leg, and the few before them that
/// are cheaper by estimate; the cheapest first. Without such: those before the latest leg that is left.
std::vector<Candidate> take_group(std::vector<Candidate>& left, std::size_t near) {
  const bool is_first = left.front().leg >= near;
  const std::size_t from = is_first ? near : left.front().leg;
  std::vector<Candidate> group, others;
  for (Candidate& candidate : left) (candidate.leg >= from ? group : others).push_back(std::move(candidate));
  left = std::move(others);
  const double least = std::min_element(group.begin(), group.end(), is_cheaper)->extra;
  for (std::size_t k = 0; is_first && k < kCheapEarlier && !left.empty(); ++k) {
    const auto cheapest = std::min_element(left.begin(), left.end(), is_cheaper);
    if (cheapest->extra >= least) break;
    group.push_back(std::move(*cheapest));
    left.erase(cheapest);
  }
  std::stable_sort(group.begin(), group.end(), is_cheaper);
  return group;
}

struct Attempt {
  MissionRequest mission{};
  Plan plan{};
};

/// The quality of an attempt: without a breach, a lower cost is better; else a later breach is better.
std::pair<bool, double> rank(const Attempt& attempt) {
  const Plan& plan = attempt.plan;
  return touches_reserve(plan) ? std::pair(false, static_cast<double>(*plan.battery->fails_on_leg))
                               : std::pair(true, -cost(plan, attempt.mission.objective));
}

/// Adds stops until the battery suffices, and goes back where that leads nowhere.
class StopSearch {
 public:
  StopSearch(const Plant& plant, const PlanLegs& plan_legs, std::optional<int> most_plans = {})
      : plant_(plant), plan_legs_(plan_legs), budget_(most_plans) {}

  /// A mission with more stops than `from` that drives; nothing where none is found.
  std::optional<Attempt> beyond(const Attempt& from, int stops) {
    if (stops == kMostStops) return std::nullopt;
    const std::size_t fails = *from.plan.battery->fails_on_leg;
    const std::size_t near = fails - std::min(fails, kEarlierLegs);
    std::vector<Candidate> left = with_one_more_stop(from.mission, from.plan, plant_, fails);
    while (!left.empty())
      if (auto found = best_of(from, take_group(left, near), stops)) return found;
    return std::nullopt;
  }

 private:
  /// The best one of these, or one with more stops where one alone is not enough.
  std::optional<Attempt> best_of(const Attempt& from, std::vector<Candidate> candidates, int stops) {
    std::vector<Attempt> attempts;
    double dear = kNoLimit;
    if (!budget_) budget_ = kMostStops * static_cast<int>(candidates.size()) + kMostPlans;
    for (Candidate& candidate : candidates) {
      const double estimate = cost(from.plan, from.mission.objective) + candidate.extra;
      if (estimate > dear) break;
      if ((*budget_)-- <= 0) break;
      Plan plan = plan_legs_(candidate.mission);
      // The inserted stop increases the indices of the legs by one; only a breach beyond that is progress.
      const bool further =
          touches_reserve(plan) && *plan.battery->fails_on_leg > *from.plan.battery->fails_on_leg + 1;
      if (is_driven(plan)) dear = std::min(dear, kDear * estimate);
      if (is_driven(plan) || further) attempts.push_back({std::move(candidate.mission), std::move(plan)});
    }
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return rank(a) > rank(b); });
    for (Attempt& attempt : attempts) {
      if (is_driven(attempt.plan)) return std::optional(std::move(attempt));
      if (auto found = beyond(attempt, stops + 1)) return found;
    }
    return std::nullopt;
  }

  const Plant& plant_;
  const PlanLegs& plan_legs_;
  std::optional<int> budget_{};  ///< plans: one descent to the most stops, and kMostPlans beside it
};

}  // namespace

Plan charge_on_the_way(Plan failed, const MissionRequest& mission, const Plant& plant,
                       const PlanLegs& plan_legs, const PlanLegs& plan_refined) {
  if (!mission.charging || !touches_reserve(failed)) return failed;
  if (auto found = StopSearch(plant, plan_legs).beyond({mission, failed}, 0)) {
    if (!plan_refined) return std::move(found->plan);
    if (Plan plan = plan_refined(found->mission); is_driven(plan)) return plan;
  }
  if (plan_refined)
    if (auto found = StopSearch(plant, plan_refined, kMostRefined).beyond({mission, failed}, 0))
      return std::move(found->plan);
  failed.message = failed.infeasibility->reason.message += "; no charging stop that was tried prevents it";
  return failed;
}

}  // namespace joulepath
