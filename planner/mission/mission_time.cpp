#include "planner/mission/mission_time.hpp"

#include <algorithm>
#include <cmath>

#include "model/config_error.hpp"
#include "planner/legs/stretch.hpp"
#include "planner/profile/request_check.hpp"

namespace joulepath {
namespace {

/// The price of a second that passes in any case. Where a second had no price at all, the time would be
/// unbounded.
double waiting_price_W(double standby_W) { return -0.9999 * standby_W; }

/// Price at which a leg alone takes a given time. A long time has a negative price, down to that at which the
/// robot waits instead.
double price_for_duration(LegTiming& leg, double duration_s, double standby_W, SolverChoice solver) {
  const double free_W = waiting_price_W(standby_W);
  const TimeSplit split =
      split_time({.legs = 1,
                  .duration_s = [&](std::size_t, double price_W) { return leg.duration_s(price_W, solver); },
                  .least_s = [&](std::size_t) { return leg.least_s(solver); },
                  .latest_arrival_s = {duration_s},
                  .earliest_arrival_s = {0.0},
                  .dwell_s = {0.0},
                  .lowest_price_W = free_W,
                  .waiting_price_W = free_W});
  return split.late ? kNoLimit : split.price_W.front();
}

/// One round, at the present times of day of the stretches.
TimeSplit share_once(PreparedLegs& prepared, const MissionRequest& mission, double standby_W,
                     SolverChoice solver) {
  const double floor_W = lowest_price_W(mission.objective);
  const std::size_t count = prepared.legs.size();
  std::vector<double> own_price_W(count, std::nan(""));
  TimeSplitRequest request{.legs = count,
                           .duration_s = {},
                           .least_s = {},
                           .latest_arrival_s = std::vector<double>(count, kNoLimit),
                           .earliest_arrival_s = std::vector<double>(count, 0.0),
                           .dwell_s = {},
                           .lowest_price_W = std::isinf(floor_W) ? 0.0 : floor_W,
                           .waiting_price_W = waiting_price_W(standby_W)};
  for (std::size_t k = 0; k < count; ++k) {
    const LegRequest& leg = mission.legs[k];
    request.dwell_s.push_back(leg.dwell_s);
    if (leg.deadline_s) request.latest_arrival_s[k] = *leg.deadline_s;
    if (leg.earliest_s) request.earliest_arrival_s[k] = *leg.earliest_s;
    if (leg.duration_s)
      own_price_W[k] = price_for_duration(prepared.timing[k], *leg.duration_s, standby_W, solver);
    else if (std::isinf(floor_W))
      own_price_W[k] = kNoLimit;
  }
  if (mission.objective.deadline_s && count > 0)
    request.latest_arrival_s.back() = std::min(request.latest_arrival_s.back(),
                                               *mission.objective.deadline_s - mission.legs.back().dwell_s);
  request.duration_s = [&](std::size_t leg, double price_W) {
    if (prepared.legs[leg].prescribed) return prepared.legs[leg].duration_s;
    const double own_s =
        prepared.timing[leg].duration_s(std::isnan(own_price_W[leg]) ? price_W : own_price_W[leg], solver);
    return mission.legs[leg].duration_s ? std::max(own_s, *mission.legs[leg].duration_s) : own_s;
  };
  request.least_s = [&](std::size_t leg) {
    if (prepared.legs[leg].prescribed) return prepared.legs[leg].duration_s;
    return std::max(prepared.timing[leg].least_s(solver), mission.legs[leg].duration_s.value_or(0.0));
  };
  TimeSplit split = split_time(request);
  for (std::size_t k = 0; k < count; ++k)
    if (!std::isnan(own_price_W[k])) split.price_W[k] = own_price_W[k];
  return split;
}

bool depends_on_time(const Plant& plant) {
  return plant.resistance_factor(0.0) != plant.resistance_factor(1e3);
}

/// Sets the time of day at which every stretch begins (windings warm up), from the mission's start.
void set_times_of_day(PreparedLegs& prepared, const TimeSplit& split, const MissionRequest& mission,
                      SolverChoice solver) {
  double departure_s = 0.0;
  for (std::size_t k = 0; k < prepared.timing.size(); ++k) {
    LegTiming& timing = prepared.timing[k];
    std::vector<double> durations_s;
    for (const ProfileResult& result : timing.solve(split.price_W[k], solver))
      durations_s.push_back(result.profile ? result.profile->duration_s() : 0.0);
    double time_s = departure_s;
    for (std::size_t piece = 0; piece < durations_s.size(); ++piece) {
      timing.stretches()[piece].time_of_day_s = time_s;
      time_s += durations_s[piece];
    }
    timing.forget();
    departure_s = split.arrival_s[k] + mission.legs[k].dwell_s;
  }
}

bool slower_is_always_cheaper(LegTiming& leg) {
  return std::any_of(leg.stretches().begin(), leg.stretches().end(), [](ProfileRequest request) {
    request.time = {};
    return joulepath::slower_is_always_cheaper(request);
  });
}

/// The latest arrival (s) that a mission allows at the end of a leg; infinite where it sets none.
double latest_s(const MissionRequest& mission, std::size_t leg) {
  double due_s = mission.objective.deadline_s.value_or(kNoLimit);
  for (std::size_t k = leg; k < mission.legs.size(); ++k)
    due_s = std::min(due_s, mission.legs[k].deadline_s.value_or(kNoLimit));
  return mission.legs[leg].duration_s.value_or(due_s);
}

}  // namespace

bool prices_moved(const std::vector<double>& before_W, const std::vector<double>& after_W) {
  for (std::size_t k = 0; k < before_W.size(); ++k)
    if (before_W[k] != after_W[k] &&
        !(std::abs(before_W[k] - after_W[k]) < 0.1 + 0.02 * std::abs(after_W[k])))
      return true;
  return false;
}

double middle_price_W(const Plan& plan) {
  // Times the mean power of driving. Without its ways, fronts were up to 0.2 % dearer than plans.
  constexpr double kMiddle = 4;
  double energy_J = 0, duration_s = 1e-9;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      energy_J += stretch.energy.total_J();
      duration_s += stretch.profile.duration_s();
    }
  return kMiddle * energy_J / duration_s;
}

double first_price_W(const MissionRequest& mission, const MissionWorld& world, const Plant& plant) {
  constexpr double kAnyPrice_W = 1.0;
  const double lowest_W = lowest_price_W(mission.objective);
  if (lowest_W > 0) return lowest_W;
  const ProfileRequest straight{
      .piece = straight_piece({}, 1.0), .plant = plant, .limits = limits_along(world.robot, {})};
  return slower_is_always_cheaper(straight) ? kAnyPrice_W : lowest_W;
}

void bound_open_times(PreparedLegs& prepared, const MissionRequest& mission) {
  constexpr double kSpare = 2;
  if (lowest_price_W(mission.objective) > 0) return;
  for (std::size_t k = 0; k < prepared.timing.size(); ++k) {
    if (!slower_is_always_cheaper(prepared.timing[k])) continue;
    const double most_s = latest_s(mission, k);
    if (std::isinf(most_s))
      throw ConfigError(
          {.mark = {mission.robot_file, 0, 0},
           .key = "power.standby_W",
           .found = "0 W and no dry friction: slower is always cheaper (legs[" + std::to_string(k) + "])",
           .accepted = "standby_W above 0, or a mission with a deadline or a duration",
           .hint = {}});
    prepared.timing[k].give(kSpare * most_s);
  }
}

double lowest_price_W(const Objective& objective) {
  switch (objective.minimize) {
    case Objective::Minimize::time:
      return kNoLimit;
    case Objective::Minimize::energy_and_time:
      return objective.time_value_W;
    case Objective::Minimize::energy:
      return 0.0;
  }
  return 0.0;
}

double cost(double energy_J, double time_s, const Objective& objective) {
  const double floor_W = lowest_price_W(objective);
  return std::isinf(floor_W) ? time_s : energy_J + floor_W * time_s;
}

double cost(const Plan& plan, const Objective& objective) {
  return cost(plan.energy.total_J(), plan.duration_s, objective);
}

TimeSplit share_time(PreparedLegs& prepared, const MissionRequest& mission, const Plant& plant,
                     SolverChoice solver) {
  const double standby_W = plant.robot.power.standby_W;
  TimeSplit split = share_once(prepared, mission, standby_W, solver);
  if (depends_on_time(plant))
    for (int pass = 0; pass < 3; ++pass) {
      set_times_of_day(prepared, split, mission, solver);
      split = share_once(prepared, mission, standby_W, solver);
    }
  return split;
}

std::pair<double, Pose> place_after(LegTiming& leg, Pose pose, double elapsed_s, SolverChoice solver) {
  double s_m = 0.0;
  for (std::size_t k = 0; k < leg.stretches().size(); ++k) {
    const PathPiece& piece = leg.stretches()[k].piece;
    const ProfileResult& result = leg.solve(kNoLimit, solver)[k];
    if (!result.profile) break;
    const double here_s = std::clamp(elapsed_s, 0.0, result.profile->duration_s());
    const double s = result.profile->at_time(here_s).s;
    pose = piece_point(piece, s).pose;
    s_m += is_turn(piece) ? 0.0 : s;
    elapsed_s -= result.profile->duration_s();
    if (elapsed_s <= 0) break;
  }
  return {s_m, pose};
}

}  // namespace joulepath
