#include "planner/mission.hpp"

#include <algorithm>
#include <cmath>

#include "planner/battery_account.hpp"
#include "planner/leg_path.hpp"
#include "planner/leg_timing.hpp"
#include "planner/plan_accounts.hpp"
#include "planner/prescribed_leg.hpp"
#include "planner/time_split.hpp"

namespace joulepath {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Everything about a mission that is known before its times are.
struct Draft {
  std::vector<LegTiming> timing{};
  std::vector<LegPlan> legs{};
};

Plan infeasible(Plan plan, std::size_t leg, double arc_length_m, Infeasibility reason) {
  plan.status = SolveStatus::infeasible;
  plan.message = reason.message;
  plan.infeasibility = {.reason = std::move(reason), .leg = leg, .arc_length_m = arc_length_m};
  return plan;
}

std::optional<Infeasibility> payload_too_heavy(const Robot& robot, const LegRequest& leg, const Pose& pose) {
  const double most_kg = std::max(leg.payload.from_kg, leg.payload.to_kg);
  const double limit_kg = robot.limits ? robot.limits->max_payload_kg : kNoLimit;
  if (most_kg <= limit_kg) return std::nullopt;
  return Infeasibility{.constraint = "max_payload",
                       .x_m = pose.x_m,
                       .y_m = pose.y_m,
                       .amount = most_kg - limit_kg,
                       .unit = "kg",
                       .relaxation = {{"max_payload_kg", most_kg}},
                       .message = "the payload exceeds what the robot may carry"};
}

/// Paths and profile requests of all legs; fills plan.infeasibility where a leg has none.
Draft draft_legs(const MissionRequest& mission, const MissionWorld& world, const RouteSpace* space,
                 const Plant& plant, const PlanOptions& options, Plan& plan) {
  Draft draft;
  LegStart start{.pose = mission.start.pose, .heading_free = !mission.start.heading_given};
  for (std::size_t k = 0; k < mission.legs.size(); ++k) {
    const LegRequest& leg = mission.legs[k];
    if (auto reason = payload_too_heavy(world.robot, leg, start.pose)) {
      plan = infeasible(std::move(plan), k, 0.0, std::move(*reason));
      return draft;
    }
    if (leg.motion) {
      draft.timing.emplace_back(std::vector<ProfileRequest>{});
      draft.legs.push_back(prescribed_leg(leg, plant, start.pose));
      start.pose =
          sampled_state(*draft.legs.back().prescribed, draft.legs.back().prescribed->time_s.back()).pose;
      continue;
    }
    LegPath way = leg_path(leg, k, start, mission, space, options);
    if (way.infeasibility) {
      const double s_m = way.infeasibility->s;
      plan = infeasible(std::move(plan), k, s_m, std::move(*way.infeasibility));
      return draft;
    }
    draft.timing.emplace_back(stretches_of(way.path, leg, k, mission, world, plant, options));
    draft.legs.push_back({.to = leg.path ? "path" : leg.to,
                          .path_source = way.source,
                          .payload = leg.payload,
                          .dwell_s = leg.dwell_s,
                          .distance_m = way.path.distance_m(),
                          .turned_rad = way.path.turned_rad(),
                          .alternatives = way.alternatives});
    if (way.path.pieces.empty()) continue;
    start = {.pose = way.path.end(), .heading_free = false};
  }
  return draft;
}

double lowest_price_W(const Objective& objective) {
  switch (objective.minimize) {
    case Objective::Minimize::time:
      return kInfinite;
    case Objective::Minimize::energy_and_time:
      return objective.time_value_W;
    case Objective::Minimize::energy:
      return 0.0;
  }
  return 0.0;
}

/// Price at which a leg alone takes a given time; a long time has a negative price, down to where
/// standby is paid back in full and the robot rather waits.
double price_for_duration(LegTiming& leg, double duration_s, double standby_W, SolverChoice solver) {
  const TimeSplit split =
      split_time({.legs = 1,
                  .duration_s = [&](std::size_t, double price_W) { return leg.duration_s(price_W, solver); },
                  .latest_arrival_s = {duration_s},
                  .earliest_arrival_s = {0.0},
                  .dwell_s = {0.0},
                  .lowest_price_W = -0.99 * standby_W});
  return split.late ? kInfinite : split.price_W.front();
}

/// Where the robot is on leg `leg` when `elapsed_s` have passed since its departure at minimum time.
std::pair<double, Pose> place_after(LegTiming& leg, double elapsed_s, SolverChoice solver) {
  double s_m = 0.0;
  Pose pose{};
  for (std::size_t k = 0; k < leg.stretches().size(); ++k) {
    const PathPiece& piece = leg.stretches()[k].piece;
    const ProfileResult& result = leg.solve(kInfinite, solver)[k];
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

/// The first stretch of any leg that no profile can drive.
bool check_each_leg(Draft& draft, double price_W, SolverChoice solver, Plan& plan) {
  for (std::size_t leg = 0; leg < draft.timing.size(); ++leg) {
    double offset_m = 0.0;
    const auto& results = draft.timing[leg].solve(price_W, solver);
    for (std::size_t k = 0; k < results.size(); ++k) {
      const PathPiece& piece = draft.timing[leg].stretches()[k].piece;
      if (!results[k].profile) {
        if (results[k].infeasibility) {
          const double s_m = offset_m + (is_turn(piece) ? 0.0 : results[k].infeasibility->s);
          plan = infeasible(std::move(plan), leg, s_m, *results[k].infeasibility);
        } else {
          plan.status = SolveStatus::failed;
          plan.message = "leg " + std::to_string(leg) + ": " + results[k].summary.message;
        }
        return false;
      }
      if (!is_turn(piece)) offset_m += piece_length(piece);
    }
  }
  return true;
}

/// Times of all legs: fixed durations on their own, all others at equal prices within the deadlines.
TimeSplit share_time(Draft& draft, const MissionRequest& mission, double standby_W, SolverChoice solver) {
  const double floor_W = lowest_price_W(mission.objective);
  const std::size_t count = draft.legs.size();
  std::vector<double> own_price_W(count, std::nan(""));
  TimeSplitRequest request{.legs = count,
                           .duration_s = {},
                           .latest_arrival_s = std::vector<double>(count, kInfinite),
                           .earliest_arrival_s = std::vector<double>(count, 0.0),
                           .dwell_s = {},
                           .lowest_price_W = std::isinf(floor_W) ? 0.0 : floor_W};
  for (std::size_t k = 0; k < count; ++k) {
    const LegRequest& leg = mission.legs[k];
    request.dwell_s.push_back(leg.dwell_s);
    if (leg.deadline_s) request.latest_arrival_s[k] = *leg.deadline_s;
    if (leg.earliest_s) request.earliest_arrival_s[k] = *leg.earliest_s;
    if (leg.duration_s)
      own_price_W[k] = price_for_duration(draft.timing[k], *leg.duration_s, standby_W, solver);
    else if (std::isinf(floor_W))
      own_price_W[k] = kInfinite;
  }
  if (mission.objective.deadline_s && count > 0)
    request.latest_arrival_s.back() = std::min(request.latest_arrival_s.back(),
                                               *mission.objective.deadline_s - mission.legs.back().dwell_s);
  request.duration_s = [&](std::size_t leg, double price_W) {
    if (draft.legs[leg].prescribed) return draft.legs[leg].duration_s;
    const double own_s =
        draft.timing[leg].duration_s(std::isnan(own_price_W[leg]) ? price_W : own_price_W[leg], solver);
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

/// Tells every stretch when it begins (windings warm up), counted from the mission's start.
void set_times_of_day(Draft& draft, const TimeSplit& split, const MissionRequest& mission,
                      SolverChoice solver) {
  double departure_s = 0.0;
  for (std::size_t k = 0; k < draft.timing.size(); ++k) {
    LegTiming& timing = draft.timing[k];
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

/// The final solution of a leg at its price, replayed and accounted for.
void settle_leg(LegPlan& leg, LegTiming& timing, double price_W, double duration_s,
                const PlanOptions& options, const Plant& plant) {
  if (leg.prescribed) return;
  const std::vector<ProfileResult>& results = timing.solve(price_W, options.solver);
  leg.price_of_time_W = std::isinf(price_W) ? 0.0 : price_W;
  leg.status = SolveStatus::optimal;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const ProfileResult& result = results[k];
    leg.status = std::max(leg.status, result.summary.status);
    if (!result.profile) return;
    StretchPlan stretch{
        .request = timing.stretches()[k], .profile = *result.profile, .summary = result.summary};
    stretch.request.time = {.mode = TimeMode::fixed_time, .duration_s = result.profile->duration_s()};
    stretch.replay = replay(stretch.request, stretch.profile);
    stretch.energy = energy_by_cause(path_motion(stretch.request), stretch.profile);
    leg.duration_s += stretch.profile.duration_s();
    leg.energy += stretch.energy;
    leg.stretches.push_back(std::move(stretch));
  }
  const double wait_s = std::max(0.0, duration_s - leg.duration_s);  // a duration longer than any use
  if (wait_s > 1e-6 * duration_s && !leg.stretches.empty()) {
    leg.stretches.back().profile.wait_s += wait_s;
    leg.duration_s += wait_s;
    leg.energy.standby_J += plant.robot.power.standby_W * wait_s;
    leg.stretches.back().energy.standby_J += plant.robot.power.standby_W * wait_s;
  }
  leg.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
}

}  // namespace

std::optional<RouteSpace> route_space(const MissionRequest& mission, const MissionWorld& world) {
  if (!world.map) return std::nullopt;
  return RouteSpace(*world.map, world.keepout ? &*world.keepout : nullptr, world.robot.footprint,
                    mission.clearance_m);
}

Plan plan_mission(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                  const RouteSpace* space) {
  std::optional<RouteSpace> own_space;
  if (!space && (own_space = route_space(mission, world))) space = &*own_space;
  Plan plan{.mission = mission.name, .status = SolveStatus::optimal};
  const Plant plant = make_plant(world.robot);
  Draft draft = draft_legs(mission, world, space, plant, options, plan);
  if (plan.status != SolveStatus::optimal) return plan;
  const double floor_W = lowest_price_W(mission.objective);
  if (!check_each_leg(draft, floor_W, SolverChoice::fast, plan)) return plan;

  TimeSplit split = share_time(draft, mission, plant.robot.power.standby_W, SolverChoice::fast);
  if (depends_on_time(plant))
    for (int pass = 0; pass < 3; ++pass) {
      set_times_of_day(draft, split, mission, SolverChoice::fast);
      split = share_time(draft, mission, plant.robot.power.standby_W, SolverChoice::fast);
    }
  if (split.late) {
    const std::size_t leg = split.late->leg;
    const double at_deadline_s = split.duration_s[leg] - split.late->amount_s;
    const auto [s_m, pose] = place_after(draft.timing[leg], at_deadline_s, SolverChoice::fast);
    return infeasible(std::move(plan), leg, s_m, late_arrival(mission, leg, split.late->amount_s, s_m, pose));
  }
  for (std::size_t k = 0; k < draft.legs.size(); ++k) {
    LegPlan& leg = draft.legs[k];
    const LegRequest& asked = mission.legs[k];
    if (asked.duration_s && split.duration_s[k] > *asked.duration_s * (1 + 1e-9) + 1e-9) {
      const auto [s_m, pose] = place_after(draft.timing[k], *asked.duration_s, SolverChoice::fast);
      return infeasible(std::move(plan), k, s_m,
                        too_short(*asked.duration_s, split.duration_s[k], s_m, pose));
    }
    leg.start_s = k == 0 ? 0.0 : split.arrival_s[k - 1] + draft.legs[k - 1].dwell_s;
    settle_leg(leg, draft.timing[k], split.price_W[k], split.duration_s[k], options, plant);
    leg.baselines = leg_baselines(leg);
  }
  plan.legs = std::move(draft.legs);
  sum_up(plan, plant, options.accuracy);
  plan.battery = battery_account(plan, plant, mission.start.battery_fraction.value_or(1.0));
  if (auto reason = battery_too_small(plan, plant)) {
    const std::size_t leg = *plan.battery->fails_on_leg;
    plan = infeasible(std::move(plan), leg, 0.0, std::move(*reason));
  }
  return plan;
}

}  // namespace joulepath
