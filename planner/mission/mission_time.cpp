#include "planner/mission/mission_time.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

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

std::pair<double, Pose> place_after(LegTiming& leg, double elapsed_s, SolverChoice solver) {
  double s_m = 0.0;
  Pose pose{};
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
