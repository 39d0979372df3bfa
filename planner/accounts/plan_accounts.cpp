#include "planner/accounts/plan_accounts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "model/progress.hpp"
#include "model/workers.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "planner/baselines/baseline.hpp"
#include "planner/baselines/comparison.hpp"

namespace joulepath {
namespace {

void add_leg(BaselineTotal& total, const BaselineTotal& leg) {
  total.name = leg.name;
  if (!leg.feasible) {
    total.feasible = false;
    if (total.reason.empty()) total.reason = leg.reason;
  }
  total.energy_J += leg.energy_J;
  total.motion_energy_J += leg.motion_energy_J;
  total.duration_s += leg.duration_s;
  total.later_s += leg.later_s;
  total.optimum_J += leg.optimum_J;
  total.optimum_motion_J += leg.optimum_motion_J;
}

void add_replay(Plan& plan, const LegPlan& leg, double standby_W) {
  for (const StretchPlan& stretch : leg.stretches) {
    plan.replay_energy_J += stretch.replay.energy_J;
    plan.iterations += stretch.summary.iterations;
    plan.local |= stretch.summary.local;
    if (stretch.replay.worst_violation > plan.worst_violation) {
      plan.worst_violation = stretch.replay.worst_violation;
      plan.worst_limit = stretch.replay.limit;
    }
  }
  if (leg.prescribed)
    plan.replay_energy_J += leg.energy.total_J() - standby_W * leg.dwell_s;  // nothing to replay
  plan.replay_energy_J += standby_W * leg.dwell_s;
}

/// Bound, gap and status of a leg from those of its stretches.
void judge_leg(LegPlan& leg, double accuracy) {
  leg.lower_bound_J = leg.energy.total_J();
  if (leg.prescribed) return;
  double slow_s = 0, gap_J = 0;
  for (const StretchPlan& stretch : leg.stretches) {
    gap_J += stretch.energy.total_J() - stretch.summary.lower_bound_J;
    if (!std::isnan(stretch.summary.lower_bound_s))
      slow_s += stretch.profile.duration_s() - stretch.profile.wait_s - stretch.summary.lower_bound_s;
  }
  leg.lower_bound_J -= gap_J;
  leg.gap_percent = std::isnan(gap_J) ? 100 * slow_s / leg.duration_s
                                      : 100 * gap_J / std::max(1e-9, std::abs(leg.energy.total_J()));
  if (leg.status <= SolveStatus::feasible)
    leg.status = leg.gap_percent <= 100 * accuracy ? SolveStatus::optimal : SolveStatus::feasible;
}

/// What the replay found, as a sentence.
std::string breach(const Plan& plan) {
  if (plan.worst_limit == "path")
    return "the replay ends at another pose than the path: a turn is shorter than the path's resolution";
  if (std::isinf(plan.worst_violation)) return "the replay found " + plan.worst_limit + " without a bound";
  return "the replay found " + plan.worst_limit + " exceeded by " +
         std::to_string(100 * plan.worst_violation) + " %";
}

/// To milliseconds; less than some of them to two digits.
std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) < 0.0095 ? "%.2g s" : "%.3f s", value);
  return text;
}

}  // namespace

double saving_percent(double energy_J, double baseline_J) {
  return baseline_J > 0 ? 100.0 * (baseline_J - energy_J) / baseline_J : 0.0;
}

double path_gap_percent(const PathBound& bound, double energy_J) {
  return gap_percent(energy_J, bound.energy_J.value_or(std::nan("")));
}

bool far_above_bound(const LegPlan& leg) {
  constexpr double kFar_percent = 15;
  if (leg.price_of_time_W < 0) return false;  // a longer time than is useful: its standby energy is no choice
  return leg.path_bound && leg.path_bound->energy_J && leg.path_bound->part != PathBound::Part::corners &&
         path_gap_percent(*leg.path_bound, leg.energy.total_J()) > kFar_percent;
}

namespace {

/// Adds the two trapezoids to the stretches of a leg, in the plan's times, and their totals to the leg.
void add_to_leg(LegPlan& leg, double standby_W) {
  leg.baselines = {{.name = "trapezoid_max_acceleration"}, {.name = "trapezoid_best_tuned"}};
  for (StretchPlan& stretch : leg.stretches) {
    const TimedStretch planned = timed(stretch);
    for (const auto make : {trapezoid_max_acceleration, trapezoid_best_tuned})
      stretch.baselines.push_back(soonest(make, stretch.request, planned.duration_s));
    for (std::size_t b = 0; b < leg.baselines.size(); ++b)
      add_result(leg.baselines[b], stretch.baselines[b], planned);
  }
  if (leg.prescribed)  // a prescribed motion is the same in every plan
    for (BaselineTotal& baseline : leg.baselines) {
      baseline.energy_J = baseline.optimum_J = leg.energy.total_J();
      baseline.motion_energy_J = baseline.optimum_motion_J = leg.energy.motion_J();
      baseline.duration_s = leg.duration_s;
    }
  else
    for (BaselineTotal& baseline : leg.baselines) {
      baseline.energy_J += standby_W * leg.dwell_s;
      baseline.optimum_J += standby_W * leg.dwell_s;
    }
}

}  // namespace

void add_baselines(Plan& plan, double standby_W, unsigned threads) {
  for_each_index(plan.legs.size(), threads, [&](std::size_t k) {
    add_to_leg(plan.legs[k], standby_W);
    finish_steps();
  });
  for (const LegPlan& leg : plan.legs) {
    plan.baselines.resize(leg.baselines.size());
    for (std::size_t b = 0; b < leg.baselines.size(); ++b) {
      add_leg(plan.baselines[b], leg.baselines[b]);
      plan.baselines[b].duration_s += leg.dwell_s;
    }
  }
}

bool limits_jerk(const LegPlan& leg) {
  return std::any_of(leg.stretches.begin(), leg.stretches.end(), [](const StretchPlan& stretch) {
    return std::isfinite(stretch.request.limits.jerk_m_s3) && !is_turn(stretch.request.piece);
  });
}

bool limits_jerk(const Plan& plan) {
  return std::any_of(plan.legs.begin(), plan.legs.end(), [](const LegPlan& leg) { return limits_jerk(leg); });
}

void sum_up(Plan& plan, const Plant& plant, double accuracy) {
  const double standby_W = plant.robot.power.standby_W;
  double slowest_percent = 0.0;  // gap of legs that are driven in the least time
  for (LegPlan& leg : plan.legs) {
    judge_leg(leg, accuracy);
    plan.lower_bound_J += leg.lower_bound_J;
    if (std::isnan(leg.lower_bound_J)) slowest_percent = std::max(slowest_percent, leg.gap_percent);
    plan.energy += leg.energy;
    plan.duration_s += leg.duration_s + leg.dwell_s;
    plan.distance_m += leg.distance_m;
    plan.status = std::max(plan.status, leg.status);
    add_replay(plan, leg, standby_W);
    for (const StretchPlan& stretch : leg.stretches)
      if (plan.solver.empty()) plan.solver = stretch.summary.solver;
  }
  const double energy_J = plan.energy.total_J();
  plan.gap_percent =
      std::isnan(plan.lower_bound_J) ? slowest_percent : gap_percent(energy_J, plan.lower_bound_J);
  if (!std::isfinite(energy_J)) {
    plan.status = SolveStatus::failed;
    plan.message = "the energy is not a number";
  } else if (!(plan.worst_violation <= 1e-6)) {
    plan.status = SolveStatus::failed;
    plan.message = breach(plan);
  } else if (is_driven(plan)) {
    plan.status = plan.gap_percent <= 100 * accuracy ? SolveStatus::optimal : SolveStatus::feasible;
  }
}

Infeasibility late_arrival(const MissionRequest& mission, std::size_t leg, double amount_s, double s_m,
                           const Pose& pose) {
  const LegRequest& asked = mission.legs[leg];
  const bool of_mission =
      !asked.deadline_s || (mission.objective.deadline_s && leg + 1 == mission.legs.size() &&
                            *mission.objective.deadline_s - asked.dwell_s < *asked.deadline_s);
  const double deadline_s = of_mission ? *mission.objective.deadline_s : *asked.deadline_s;
  double dwell_s = of_mission ? asked.dwell_s : 0.0;
  for (std::size_t k = 0; k < leg; ++k) dwell_s += mission.legs[k].dwell_s;
  const std::string counted = !of_mission && leg > 0 ? ", counted from the mission's start" : "";
  const std::string standing =
      dwell_s > 0 ? "; " + seconds(dwell_s) + " of its time are dwell (dwell_s of the legs)" : "";
  return {.constraint = "deadline",
          .s = s_m,
          .x_m = pose.x_m,
          .y_m = pose.y_m,
          .amount = amount_s,
          .unit = "s",
          .relaxation = {{"deadline_s", deadline_s + amount_s}},
          .message = "even the fastest drive arrives " + seconds(amount_s) + " after the deadline of " +
                     seconds(deadline_s) + counted + standing};
}

Infeasibility too_short(double duration_s, double minimum_s, double s_m, const Pose& pose) {
  return {.constraint = "duration",
          .s = s_m,
          .x_m = pose.x_m,
          .y_m = pose.y_m,
          .amount = minimum_s - duration_s,
          .unit = "s",
          .relaxation = {{"duration_s", minimum_s}},
          .message = "the fastest drive takes " + seconds(minimum_s) + ", more than the duration of " +
                     seconds(duration_s)};
}

}  // namespace joulepath
