#include "planner/mission/mission.hpp"

#include <algorithm>
#include <cmath>

#include "model/assert.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/mission/charging.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/mission/visit_order.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/profile/holding_limit.hpp"

namespace joulepath {
namespace {

constexpr double kNoWait = 1e-6;  ///< relative: a wait shorter than this is rounding
constexpr int kRounds = 3;        ///< of choosing ways at the prices that the last round's times led to

/// The final solutions of a leg at its price; none for a prescribed motion.
const std::vector<ProfileResult>& final_results(LegTiming& timing, double price_W, double duration_s,
                                                const PlanOptions& options) {
  // A duration longer than any use: the bound is to know that there is no more of it. The times that
  // were shared are the fast solver's, so Ipopt has not been asked yet.
  if (price_W <= 0 && timing.duration_s(price_W, SolverChoice::fast) < duration_s * (1 - kNoWait))
    timing.give(duration_s);
  return timing.solve(price_W, options.solver);
}

/// Replays and accounts for a leg's profiles.
void settle_leg(LegPlan& leg, const LegTiming& timing, const std::vector<ProfileResult>& results,
                double price_W, double duration_s, const Plant& plant) {
  if (leg.prescribed) {
    leg.energy = prescribed_energy(leg, plant);
    leg.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
    return;
  }
  leg.price_of_time_W = std::isinf(price_W) ? 0.0 : price_W;
  leg.status = SolveStatus::optimal;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const ProfileResult& result = results[k];
    leg.status = std::max(leg.status, result.summary.status);
    StretchPlan stretch{
        .request = timing.stretches()[k], .profile = *result.profile, .summary = result.summary};
    stretch.request.time = {.mode = TimeMode::fixed_time, .duration_s = result.profile->duration_s()};
    stretch.replay = replay(stretch.request, stretch.profile);
    stretch.energy = energy_by_cause(path_motion(stretch.request), stretch.profile);
    leg.duration_s += stretch.profile.duration_s();
    leg.energy += stretch.energy;
    leg.stretches.push_back(std::move(stretch));
  }
  const double wait_s = std::max(0.0, duration_s - leg.duration_s);
  if (wait_s > kNoWait * duration_s && !leg.stretches.empty()) {
    leg.stretches.back().profile.wait_s += wait_s;
    leg.duration_s += wait_s;
    leg.energy.standby_J += plant.robot.power.standby_W * wait_s;
    leg.stretches.back().energy.standby_J += plant.robot.power.standby_W * wait_s;
    leg.stretches.back().replay.energy_J += plant.robot.power.standby_W * wait_s;
  }
  leg.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
}

/// Whether prices moved so much that another way might be the better one.
bool moved(const std::vector<double>& before_W, const std::vector<double>& after_W) {
  for (std::size_t k = 0; k < before_W.size(); ++k)
    if (before_W[k] != after_W[k] &&
        !(std::abs(before_W[k] - after_W[k]) < 0.1 + 0.02 * std::abs(after_W[k])))
      return true;
  return false;
}

/// Legs whose ways were chosen at the prices of their times; the plan becomes the verdict where there are
/// none.
struct TimedLegs {
  PreparedLegs prepared{};
  TimeSplit split{};
};
TimedLegs time_legs(const MissionRequest& mission, const MissionWorld& world, const RouteSpace* space,
                    const Plant& plant, const PlanOptions& options, Plan& plan) {
  const double floor_W = lowest_price_W(mission.objective);
  std::vector<double> price_W(mission.legs.size(), floor_W);
  TimedLegs timed;
  const MissionWays ways(mission, world, space, plant, options);
  const auto choose = [&](bool quick) {
    timed.prepared = prepare_legs(mission, world, plant, options, ways.choose(price_W, quick), plan);
    return plan.status == SolveStatus::optimal;
  };
  const auto share = [&](bool roughly) {
    for (LegTiming& timing : timed.prepared.timing) timing.solve_roughly(roughly);
    if (!check_each_leg(timed.prepared, floor_W, SolverChoice::fast, plan)) return false;
    timed.split = share_time(timed.prepared, mission, plant, SolverChoice::fast);
    return true;
  };
  for (int round = 0; space && round < kRounds; ++round) {
    if (!choose(true) || !share(true)) return timed;
    const bool settled = !moved(price_W, timed.split.price_W);
    price_W = timed.split.price_W;
    if (settled) break;
  }
  if (!choose(false)) return timed;
  check_end_speeds(timed.prepared, mission);
  share(false);
  return timed;
}

/// Which limit holds the fastest drive of a leg.
std::string held_by(LegTiming& leg) {
  HoldingLimits limits;
  double before_m = 0.0;
  const std::vector<ProfileResult>& fastest = leg.solve(kNoLimit, SolverChoice::fast);
  for (std::size_t k = 0; k < fastest.size(); ++k) {
    const ProfileRequest& stretch = leg.stretches()[k];
    if (fastest[k].profile) limits.add(stretch, *fastest[k].profile, before_m);
    before_m += is_turn(stretch.piece) ? 0.0 : piece_length(stretch.piece);
  }
  return limits.sentence();
}

/// The verdict where a deadline or a duration cannot be met.
std::optional<PlanInfeasibility> too_late(TimedLegs& timed, const MissionRequest& mission) {
  TimeSplit& split = timed.split;
  if (split.late) {
    const std::size_t leg = split.late->leg;
    const auto [s_m, pose] = place_after(timed.prepared.timing[leg],
                                         split.duration_s[leg] - split.late->amount_s, SolverChoice::fast);
    Infeasibility reason = late_arrival(mission, leg, split.late->amount_s, s_m, pose);
    reason.message += held_by(timed.prepared.timing[leg]);
    return PlanInfeasibility{std::move(reason), leg, s_m};
  }
  for (std::size_t k = 0; k < timed.prepared.legs.size(); ++k) {
    const std::optional<double>& asked_s = mission.legs[k].duration_s;
    if (!asked_s || split.duration_s[k] <= *asked_s * (1 + 1e-9) + 1e-9) continue;
    const auto [s_m, pose] = place_after(timed.prepared.timing[k], *asked_s, SolverChoice::fast);
    Infeasibility reason = too_short(*asked_s, split.duration_s[k], s_m, pose);
    reason.message += held_by(timed.prepared.timing[k]);
    return PlanInfeasibility{std::move(reason), k, s_m};
  }
  return std::nullopt;
}

bool has_own_duration(const MissionRequest& mission) {
  return std::any_of(mission.legs.begin(), mission.legs.end(),
                     [](const LegRequest& leg) { return leg.duration_s.has_value(); });
}

/// Plans the legs as they are, in their order; `plan` has what is known about the mission already.
Plan plan_given_legs(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                     const RouteSpace* space, const Plant& plant, Plan plan) {
  TimedLegs timed = time_legs(mission, world, space, plant, options, plan);
  if (plan.status != SolveStatus::optimal) return plan;
  if (auto verdict = too_late(timed, mission))
    return infeasible(std::move(plan), verdict->leg, verdict->arc_length_m, verdict->reason);

  for (std::size_t k = 0; k < timed.prepared.legs.size(); ++k) {
    LegPlan& leg = timed.prepared.legs[k];
    leg.start_s = k == 0 ? 0.0 : timed.split.arrival_s[k - 1] + timed.prepared.legs[k - 1].dwell_s;
    LegTiming& timing = timed.prepared.timing[k];
    const double price_W = timed.split.price_W[k], duration_s = timed.split.duration_s[k];
    const std::vector<ProfileResult>& results = final_results(timing, price_W, duration_s, options);
    if (!all_driven(k, timing.stretches(), results, plan)) return plan;
    settle_leg(leg, timing, results, price_W, duration_s, plant);
    if (options.baselines) leg.baselines = leg_baselines(leg);
  }
  plan.legs = std::move(timed.prepared.legs);
  sum_up(plan, plant, options.accuracy);
  plan.battery = battery_account(plan, plant, mission.start.battery_fraction.value_or(1.0),
                                 mission.charging ? mission.charging->to_fraction : 1.0);
  if (auto reason = battery_too_small(plan, plant)) {
    const std::size_t leg = *plan.battery->fails_on_leg;
    plan = infeasible(std::move(plan), leg, 0.0, std::move(*reason));
  }
  return plan;
}

const RouteSpace* need_space(const MissionRequest& mission, const RouteSpace* space) {
  if (space) return space;
  throw ConfigError({.mark = mission.marks.at("visit"),
                     .key = "visit",
                     .found = "stops to visit without a map",
                     .accepted = "`map:` beside it",
                     .hint = {}});
}

[[noreturn]] void refuse_empty(const MissionRequest& mission) {
  throw ConfigError({.mark = mission.marks.at("legs"),
                     .key = "legs",
                     .found = "no leg",
                     .accepted = "`legs:` or `visit:` with at least one stop",
                     .hint = {}});
}

}  // namespace

std::optional<RouteSpace> route_space(const MissionRequest& mission, const MissionWorld& world) {
  if (!world.map) return std::nullopt;
  return RouteSpace(*world.map, world.keepout ? &*world.keepout : nullptr, world.robot.footprint,
                    mission.clearance_m);
}

Plan plan_mission(const MissionRequest& asked, const MissionWorld& world, const PlanOptions& options,
                  const RouteSpace* space) {
  std::optional<RouteSpace> own_space;
  if (!space && (own_space = route_space(asked, world))) space = &*own_space;
  Plan plan{.mission = asked.name, .status = SolveStatus::optimal};
  const Plant plant = make_plant(world.robot);
  MissionRequest mission = asked;
  if (!asked.visit.empty() && asked.legs.empty()) {
    plan.visit = order_visits(
        {asked, world, need_space(asked, space), plant, options, lowest_price_W(asked.objective)});
    if (Infeasibility reason = plan.visit->infeasibility.value_or(Infeasibility{}); plan.visit->infeasibility)
      return infeasible(std::move(plan), 0, 0.0, std::move(reason));
    mission.legs = plan.visit->legs;
  }
  if (mission.legs.empty()) refuse_empty(mission);
  const auto plan_legs = [&](const MissionRequest& legs) {
    Plan chosen = plan_given_legs(legs, world, options, space, plant, plan);
    if (chosen.status != SolveStatus::infeasible || !options.steps.corners || !has_own_duration(legs))
      return chosen;
    // Ways are chosen by energy; one that a leg's own duration has no use for must not be the last word.
    PlanOptions plain = options;
    plain.steps.corners = false;
    Plan other = plan_given_legs(legs, world, plain, space, plant, plan);
    return other.status == SolveStatus::infeasible ? chosen : other;
  };
  Plan answer = charge_on_the_way(plan_legs(mission), mission, plant, plan_legs);
  JOULEPATH_ASSERT(answer.status <= SolveStatus::feasible || !answer.message.empty(),
                   "a mission without a plan has a reason");
  return answer;
}

}  // namespace joulepath
