#include "planner/mission/mission.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "model/assert.hpp"
#include "model/config_error.hpp"
#include "model/progress.hpp"
#include "model/workers.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/accounts/state_offers.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/bound/path_bound.hpp"
#include "planner/confidence/confident_plan.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/mission/best_ways.hpp"
#include "planner/mission/charging.hpp"
#include "planner/mission/drift.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/mission/visit_order.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/profile/holding_limit.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr double kNoWait = 1e-6;  ///< relative: a shorter wait is rounding
constexpr int kRounds = 3;  ///< rounds of choosing ways at the prices that follow from the last round's times

/// The final solutions of a leg at its price; none for a prescribed motion.
const std::vector<ProfileResult>& final_results(LegTiming& timing, double price_W, double duration_s,
                                                const PlanOptions& options) {
  // The leg has more time than it uses: its bound may assume that no stretch takes longer. So far only the
  // fast solver has solved the leg.
  if (price_W <= 0 && timing.duration_s(price_W, SolverChoice::fast) < duration_s * (1 - kNoWait))
    timing.give(duration_s);
  return timing.solve(price_W, options.solver);
}

/// Time (s) at rest at the end of a leg that has more time than its profiles take.
double wait_of(const std::vector<ProfileResult>& results, double duration_s) {
  double wait_s = duration_s;
  for (const ProfileResult& result : results) wait_s -= result.profile->duration_s();
  return wait_s > kNoWait * duration_s ? wait_s : 0.0;
}

/// A bound L of J + price Q, with Q the copper loss and J the energy at the battery, is one of J on all
/// profiles with no more copper loss than this one: J >= L - price Q (weak duality). What of the priced loss
/// is recovered makes the priced energy no greater than J + price Q.
void take_price_out(StretchPlan& stretch, double price_of_heat) {
  stretch.summary.lower_bound_J -= price_of_heat * stretch.energy.copper_J;
  stretch.summary.gap_percent = gap_percent(stretch.energy.total_J(), stretch.summary.lower_bound_J);
}

/// Replays and accounts for a leg's profiles.
void finish_leg(LegPlan& leg, const LegTiming& timing, const std::vector<ProfileResult>& results,
                double price_W, double duration_s, const UncertainPlant& uncertain,
                const SharedAnswers& answers) {
  const Plant& plant = uncertain.plant;
  if (leg.prescribed) {
    leg.energy = prescribed_energy(leg, plant);
    leg.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
    return;
  }
  leg.in_least_time = std::isinf(price_W);
  leg.price_of_time_W = leg.in_least_time ? 0.0 : price_W;
  leg.status = SolveStatus::optimal;
  const double wait_s = wait_of(results, duration_s);
  for (std::size_t k = 0; k < results.size(); ++k) {
    const ProfileResult& result = results[k];
    leg.status = std::max(leg.status, result.summary.status);
    StretchPlan stretch{
        .request = timing.stretches()[k], .profile = *result.profile, .summary = result.summary};
    stretch.request.time = {.mode = TimeMode::fixed_time, .duration_s = result.profile->duration_s()};
    if (k + 1 == results.size()) stretch.profile.wait_s += wait_s;
    stretch.request.plant.heat_price_ohm = {};
    account_for(stretch, uncertain, answers);
    if (leg.state.price_of_heat > 0) take_price_out(stretch, leg.state.price_of_heat);
    if (k + 1 == results.size()) bound_wait(stretch, wait_s, leg.price_of_time_W);
    leg.duration_s += stretch.profile.duration_s();
    leg.energy += stretch.energy;
    leg.stretches.push_back(std::move(stretch));
  }
  if (results.empty()) {
    leg.duration_s = wait_s;
    leg.energy.standby_J += plant.robot.power.standby_W * wait_s;
  }
  leg.energy.standby_J += plant.robot.power.standby_W * leg.dwell_s;
}

/// Legs whose ways were chosen at the prices of their times; where there are none, the plan is the verdict.
struct TimedLegs {
  PreparedLegs prepared{};
  TimeSplit split{};
};
/// `way_price_W`: the price at which ways are chosen, where it is not that of their times.
TimedLegs time_legs(const MissionRequest& mission, const MissionWorld& world, const RouteSpace* space,
                    const Plant& plant, const PlanOptions& options, const std::vector<LegState>& states,
                    std::optional<double> way_price_W, Plan& plan) {
  const double floor_W = lowest_price_W(mission.objective);
  std::vector<double> price_W(mission.legs.size(),
                              way_price_W.value_or(first_price_W(mission, world, plant)));
  TimedLegs timed;
  // Ways are chosen for the hardest state of all legs.
  const Plant way_plant = plant_in(plant, hardest(states));
  std::optional<MissionWorld> drifted;
  if (!states.empty()) drifted = world, drifted->robot = robot_in(world.robot, hardest(states));
  const MissionWays ways(mission, drifted ? *drifted : world, space, way_plant, options);
  const auto choose = [&](bool quick) {
    timed.prepared = prepare_legs(mission, world, plant, options, states, ways.choose(price_W, quick), plan);
    bound_open_times(timed.prepared, mission);
    return plan.status == SolveStatus::optimal;
  };
  const auto share = [&](bool roughly) {
    std::vector<LegTiming>& timing = timed.prepared.timing;
    for_each_index(timing.size(), options.threads, [&](std::size_t k) {
      timing[k].solve_roughly(roughly);
      (void)timing[k].solve(floor_W, SolverChoice::fast);
    });
    if (!check_each_leg(timed.prepared, floor_W, SolverChoice::fast, plan)) return false;
    timed.split = share_time(timed.prepared, mission, plant, SolverChoice::fast);
    return true;
  };
  expect_steps(mission.legs.size());
  for (int round = 0; space && !way_price_W && round < kRounds; ++round) {
    expect_steps(mission.legs.size());
    if (!choose(true) || !share(true)) return timed;
    const bool converged = !prices_moved(price_W, timed.split.price_W);
    price_W = timed.split.price_W;
    if (converged) break;
  }
  if (!choose(false)) return timed;
  check_end_speeds(timed.prepared, mission);
  share(options.draft);
  return timed;
}

/// The limit that determines the fastest drive of a leg.
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
    const auto [s_m, pose] = place_after(timed.prepared.timing[leg], timed.prepared.legs[leg].start_pose,
                                         split.duration_s[leg] - split.late->amount_s, SolverChoice::fast);
    Infeasibility reason = late_arrival(mission, leg, split.late->amount_s, s_m, pose);
    reason.message += held_by(timed.prepared.timing[leg]);
    return PlanInfeasibility{.reason = std::move(reason), .leg = leg, .arc_length_m = s_m};
  }
  for (std::size_t k = 0; k < timed.prepared.legs.size(); ++k) {
    const std::optional<double>& asked_s = mission.legs[k].duration_s;
    if (!asked_s || split.duration_s[k] <= *asked_s * (1 + 1e-9) + 1e-9) continue;
    const auto [s_m, pose] = place_after(timed.prepared.timing[k], timed.prepared.legs[k].start_pose,
                                         *asked_s, SolverChoice::fast);
    Infeasibility reason = too_short(*asked_s, split.duration_s[k], s_m, pose);
    reason.message += held_by(timed.prepared.timing[k]);
    return PlanInfeasibility{.reason = std::move(reason), .leg = k, .arc_length_m = s_m};
  }
  return std::nullopt;
}

bool has_own_duration(const MissionRequest& mission) {
  return std::any_of(mission.legs.begin(), mission.legs.end(),
                     [](const LegRequest& leg) { return leg.duration_s.has_value(); });
}

/// Marks a draft: its limits hold at nodes only and it has no bound, so its status is neither `infeasible`
/// nor `optimal`.
void mark_as_draft(Plan& plan) {
  plan.status = SolveStatus::feasible;
  plan.message.clear();
  plan.gap_percent = std::nan("");
  for (LegPlan& leg : plan.legs) {
    leg.status = SolveStatus::feasible;
    leg.gap_percent = std::nan("");
  }
}

/// Plans the legs as given, in their order, each in its state (none: the robot as it is); `plan` contains
/// what is already known about the mission.
Plan plan_in_states(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                    const RouteSpace* space, const Plant& plant, const std::vector<LegState>& states,
                    Plan plan, std::optional<double> way_price_W) {
  expect_steps(mission.legs.size());
  TimedLegs timed = time_legs(mission, world, space, plant, options, states, way_price_W, plan);
  if (plan.status != SolveStatus::optimal) return plan;
  if (auto verdict = too_late(timed, mission))
    return infeasible(std::move(plan), verdict->leg, verdict->arc_length_m, verdict->reason);

  std::vector<LegPlan>& legs = timed.prepared.legs;
  std::vector<LegTiming>& timing = timed.prepared.timing;
  const TimeSplit& split = timed.split;
  std::vector<std::vector<ProfileResult>> results(legs.size());
  for_each_index(legs.size(), options.threads, [&](std::size_t k) {
    results[k] = final_results(timing[k], split.price_W[k], split.duration_s[k], options);
    finish_steps();
  });
  for (std::size_t k = 0; k < legs.size(); ++k)
    if (!all_driven(k, timed.prepared, results[k], plan)) return plan;
  const UncertainPlant uncertain_plant = uncertain(plant);
  const auto plant_on = [&](std::size_t k) { return uncertain(plant_in(plant, states[k])); };
  for_each_index(legs.size(), options.threads, [&](std::size_t k) {
    legs[k].start_s = k == 0 ? 0.0 : split.arrival_s[k - 1] + legs[k - 1].dwell_s;
    // A robot that arrives before the stop's window opens waits there: the wait is part of the leg.
    const double duration_s = std::max(split.duration_s[k], split.arrival_s[k] - legs[k].start_s);
    finish_leg(legs[k], timing[k], results[k], split.price_W[k], duration_s,
               states.empty() ? uncertain_plant : plant_on(k), options.answers);
  });
  plan.legs = std::move(legs);
  sum_up(plan, plant, options.accuracy);
  if (options.draft) mark_as_draft(plan);
  plan.battery = battery_account(plan, uncertain_plant, mission.start.battery_fraction.value_or(1.0),
                                 mission.charging ? mission.charging->to_fraction : 0.0);
  plan.winding = winding_account(plan, plant);
  if (auto reason = battery_too_small(plan, plant)) {
    const std::size_t leg = *plan.battery->fails_on_leg;
    plan = infeasible(std::move(plan), leg, 0.0, std::move(*reason));
  } else if (auto heat = winding_too_hot(plan, plant.robot)) {
    const std::size_t leg = *plan.winding->fails_on_leg;
    plan = infeasible(std::move(plan), leg, 0.0, std::move(*heat));
  }
  return plan;
}

/// Plans the legs as given, in their order, with the charge and the temperatures that the plan itself leads
/// to.
Plan plan_given_legs(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                     const RouteSpace* space, const Plant& plant, const Plan& known,
                     std::optional<double> way_price_W = {}) {
  const auto plan_in = [&](const std::vector<LegState>& states) {
    return plan_in_states(mission, world, options, space, plant, states, known, way_price_W);
  };
  Plan plan = drifts(world.robot) ? settled_plan(mission, world.robot, options, plan_in) : plan_in({});
  if (auto& verdict = plan.infeasibility) verdict->to = goal_name(mission.legs[verdict->leg]);
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

/// Plans legs that are given, with ways that keep a leg's own duration, and with stops at chargers.
Plan plan_with_stops(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                     const RouteSpace* space, const Plant& plant, const Plan& known) {
  const auto plan_on = [&](const MissionRequest& legs, const PlanOptions& how) {
    return plan_on_best_ways({.mission = legs, .world = world, .plant = plant, .searched = space != nullptr},
                             [&](const MissionRequest& variant, const WayChoice& choice) {
                               PlanOptions chosen = how;
                               chosen.steps.mean_ramps = choice.mean_ramps;
                               return plan_given_legs(variant, world, chosen, space, plant, known,
                                                      choice.price_W);
                             });
  };
  const auto plan_legs = [&](const MissionRequest& legs) {
    Plan chosen = plan_on(legs, options);
    if (chosen.status != SolveStatus::infeasible || !options.steps.corners || !has_own_duration(legs))
      return chosen;
    // Ways are chosen by energy. A way that cannot keep a leg's own duration is replaced by one with stops at
    // corners.
    PlanOptions plain = options;
    plain.steps.corners = false;
    Plan other = plan_given_legs(legs, world, plain, space, plant, known);
    return other.status == SolveStatus::infeasible ? chosen : other;
  };
  if (!options.steps.refinement) return charge_on_the_way(plan_legs(mission), mission, plant, plan_legs, {});
  const auto plan_unrefined = [&](const MissionRequest& legs) {
    PlanOptions unrefined = options;
    unrefined.steps.refinement = false;
    return plan_on(legs, unrefined);
  };
  return charge_on_the_way(plan_legs(mission), mission, plant, plan_unrefined, plan_legs);
}

/// Plans the stops of `visit:`, or gives the verdict that no order of them is possible.
Plan plan_stops(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                const RouteSpace* space, const Plant& plant, const Plan& known) {
  const ChoiceContext context{mission, world,   need_space(mission, space),
                              plant,   options, first_price_W(mission, world, plant)};
  Plan plan = plan_visits(context, [&](const MissionRequest& legs) {
    return plan_with_stops(legs, world, options, space, plant, known);
  });
  if (!plan.visit->infeasibility) return plan;
  Infeasibility reason = *plan.visit->infeasibility;
  Plan verdict = known;
  verdict.visit = std::move(plan.visit);
  return infeasible(std::move(verdict), 0, 0.0, std::move(reason));
}

/// Plans a mission, whatever confidence it asks for, without baselines and bound over all paths. A verdict
/// names no other states of battery and windings that would do.
Plan plan_once(const MissionRequest& asked, const MissionWorld& world, const PlanOptions& options,
               const RouteSpace* space) {
  const Plan known{.mission = asked.name, .status = SolveStatus::optimal};
  const bool visits = !asked.visit.empty() && asked.legs.empty();
  if (!visits && asked.legs.empty()) refuse_empty(asked);
  Plan answer =
      (visits ? plan_stops : plan_with_stops)(asked, world, options, space, make_plant(world.robot), known);
  JOULEPATH_ASSERT(is_driven(answer) || !answer.message.empty(), "a mission without a plan has a reason");
  return answer;
}

/// Plans what a verdict offers for limits and times.
void prove_verdict(Plan& answer, const MissionRequest& asked, const MissionWorld& world,
                   const PlanOptions& options, const RouteSpace* space) {
  prove_offers(answer, asked, world.robot, [&](const MissionRequest& mission, const Robot& robot) {
    MissionWorld other = world;
    other.robot = robot;
    try {
      return plan_once(mission, other, options, space);
    } catch (const ConfigError&) {
      return Plan{.status = SolveStatus::failed};
    }
  });
}

constexpr int kMostTrials = 30;  ///< plans of one verdict

/// Adds to a verdict what a battery or windings of other states would do: every offer was planned.
void offer_what_drifts(Plan& answer, const MissionRequest& asked, const MissionWorld& world,
                       PlanOptions options, const RouteSpace* space) {
  if (!answer.infeasibility || options.draft) return;
  options.any_price_of_heat = true;
  const double start_fraction = asked.start.battery_fraction.value_or(1.0);
  int trials = 0;
  const auto plans = [&](const MissionRequest& mission, const Robot& robot) {
    if (++trials > kMostTrials) return false;
    MissionWorld other = world;
    other.robot = robot;
    try {
      return is_driven(plan_once(mission, other, options, space));
    } catch (const ConfigError&) {  // of a leg that no plan reached before
      return false;
    }
  };
  const auto plans_by = [&](const Robot& robot) { return plans(asked, robot); };
  offer_charge(answer, world.robot, start_fraction, [&](double fraction) {
    MissionRequest fuller = asked;
    fuller.start.battery_fraction = fraction;
    return plans(fuller, world.robot);
  });
  offer_capacity(answer, world.robot, [&](double capacity_Wh) {
    Robot robot = world.robot;
    robot.battery.capacity_Wh = capacity_Wh;
    return plans(asked, robot);
  });
  offer_cooling(answer, asked, [&](const MissionRequest& mission) { return plans(mission, world.robot); });
  name_battery_keys(answer, world.robot, plans_by);
  if (answer.infeasibility->reason.constraint != "battery_power") return;
  const std::vector<LegRequest>& legs = answer.visit ? answer.visit->legs : asked.legs;
  // Stops at chargers, if any, come after the legs as asked have failed: the index is theirs.
  const PayloadAlongLeg& payload = legs[std::min(answer.infeasibility->leg, legs.size() - 1)].payload;
  blame_battery(answer, world.robot, payload, plans_by);
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
  const PlanOnce once = [&](const MissionRequest& mission, const MissionWorld& in, const PlanOptions& how) {
    return plan_once(mission, in, how, space);
  };
  const OfferOnce offer = [&](Plan& verdict, const MissionRequest& mission, const MissionWorld& in,
                              const PlanOptions& how) {
    offer_what_drifts(verdict, mission, in, how, space);
  };
  PlanOptions alone = options;
  alone.baselines = alone.path_bound = false;
  expect_steps((std::size_t{options.baselines} + std::size_t{options.path_bound}) *
               std::max(asked.legs.size(), asked.visit.size()));
  const bool sure = asked.objective.confidence && !options.draft;
  Plan answer = sure ? confident_plan(asked, world, alone, {once, offer}) : once(asked, world, alone);
  if (!sure && !options.draft) prove_verdict(answer, asked, world, alone, space);
  if (!sure) offer(answer, asked, world, alone);
  const Plant plant = make_plant(world.robot);
  if (options.baselines) add_baselines(answer, plant.robot.power.standby_W, options.threads);
  if (options.path_bound) add_path_bounds(answer, asked, world, plant, space);
  return answer;
}

}  // namespace joulepath
