#include "planner/mission/prepared_legs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/config_error.hpp"
#include "model/limit_table.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/legs/prescribed_limits.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

std::optional<Infeasibility> payload_too_heavy(const Robot& robot, const LegRequest& leg, const Pose& pose) {
  const double most_kg = std::max(leg.payload.from_kg, leg.payload.to_kg);
  const double limit_kg = payload_limit_kg(robot);
  if (most_kg <= limit_kg) return std::nullopt;
  const Limit& row = payload_limit();
  return Infeasibility{.constraint = std::string(row.name),
                       .x_m = pose.x_m,
                       .y_m = pose.y_m,
                       .amount = most_kg - limit_kg,
                       .unit = std::string(row.unit),
                       .relaxation = {{std::string(row.key), most_kg}},
                       .message = "the payload exceeds what the robot may carry"};
}

[[noreturn]] void refuse_speed(const LegRequest& leg, const std::string& key, double found_m_s,
                               const std::string& accepted) {
  throw ConfigError({.mark = leg.marks.at(key),
                     .key = leg.marks.key_path(key),
                     .found = std::to_string(found_m_s) + " m/s",
                     .accepted = accepted,
                     .hint = {}});
}

/// A leg that ends at speed must be followed by a leg at that speed, without a dwell.
void check_joint(const MissionRequest& mission, std::size_t k) {
  const LegRequest& leg = mission.legs[k];
  if (leg.dwell_s > 0 && leg.end_speed_m_s > 0)
    refuse_speed(leg, "end_speed_m_s", leg.end_speed_m_s, "0 m/s before a dwell");
  if (k + 1 == mission.legs.size()) return;
  const LegRequest& next = mission.legs[k + 1];
  if (leg.end_speed_m_s != next.start_speed_m_s)
    refuse_speed(next, "start_speed_m_s", next.start_speed_m_s,
                 "the end speed of the previous leg, " + std::to_string(leg.end_speed_m_s) + " m/s");
}

/// Adds one leg after the other, each from where the one before it ends.
class LegPreparation {
 public:
  LegPreparation(const MissionRequest& mission, const MissionWorld& world, const Plant& plant,
                 const PlanOptions& options, const std::vector<LegState>& states)
      : mission_(mission),
        world_(world),
        plant_(plant),
        options_(options),
        states_(states),
        here_(mission.start.pose) {}

  /// The reason why the leg cannot be driven, where it needs no solver.
  std::optional<Infeasibility> add(std::size_t k, LegPath way) {
    if (states_.empty()) return add_to(world_, plant_, k, std::move(way));
    const MissionWorld there{.robot = robot_in(world_.robot, states_[k]), .speed_mask = world_.speed_mask};
    return add_to(there, plant_in(plant_, states_[k]), k, std::move(way));
  }

  PreparedLegs legs() && { return std::move(prepared_); }

 private:
  std::optional<Infeasibility> add_to(const MissionWorld& world, const Plant& plant, std::size_t k,
                                      LegPath way) {
    const LegRequest& leg = mission_.legs[k];
    check_joint(mission_, k);
    if (auto reason = payload_too_heavy(world.robot, leg, here_)) return reason;
    if (way.infeasibility) return std::move(way.infeasibility);
    const bool drives = leg.motion || !way.path.pieces.empty();
    if (drives || charger_W(leg) < world.robot.power.standby_W)
      if (auto reason = battery_too_weak(world.robot, here_)) return reason;
    if (leg.motion) return add_prescribed(leg, world, plant, k);
    add_path(leg, world, plant, k, std::move(way));
    return std::nullopt;
  }

  LegState state_of(std::size_t k) const { return states_.empty() ? LegState{} : states_[k]; }

  std::optional<Infeasibility> add_prescribed(const LegRequest& leg, const MissionWorld& world,
                                              const Plant& plant, std::size_t k) {
    prepared_.timing.emplace_back(std::vector<ProfileRequest>{});
    LegPlan& plan = prepared_.legs.emplace_back(prescribed_leg(leg, plant, here_));
    plan.start_pose = here_;
    plan.memory = memory_;
    plan.state = state_of(k);
    if (auto reason = broken_limit(plan, k, mission_, world, plant)) return reason;
    begin_at(here_);
    const double end_s = plan.prescribed->time_s.back();
    here_ = sampled_state(*plan.prescribed, end_s).pose;
    memory_ = prescribed_motion(plan, plant).memory(end_s);
    return std::nullopt;
  }

  /// Of the charger at the station where the leg ends; 0: none, as at a place that an order names.
  double charger_W(const LegRequest& leg) const {
    const auto station = mission_.stations.find(leg.to);
    return station == mission_.stations.end() ? 0.0 : station->second.charger_W;
  }

  void add_path(const LegRequest& leg, const MissionWorld& world, const Plant& plant, std::size_t k,
                LegPath way) {
    const Plant priced = states_.empty() ? plant : priced_plant_in(plant_, states_[k]);
    prepared_.timing.emplace_back(stretches_of(way.path, leg, k, mission_, world, priced, options_, memory_),
                                  options_.answers);
    prepared_.legs.push_back({.to = goal_name(leg),
                              .path_source = way.source,
                              .payload = leg.payload,
                              .parts = leg.parts,
                              .start_pose = here_,
                              .memory = memory_,
                              .state = state_of(k),
                              .dwell_s = leg.dwell_s,
                              .distance_m = way.path.distance_m(),
                              .turned_rad = way.path.turned_rad(),
                              .charger_W = charger_W(leg),
                              .alternatives = std::move(way.alternatives),
                              .improvements = std::move(way.improvements)});
    if (way.path.pieces.empty()) return;
    begin_at(way.path.start());
    here_ = way.path.end();
    memory_ = memory_after(prepared_.timing.back().stretches().back());
  }

  /// The first motion begins where the mission does: a free start's heading is that of its path.
  void begin_at(const Pose& pose) {
    if (!std::exchange(moved_, true))
      for (LegPlan& leg : prepared_.legs) leg.start_pose = pose;
  }

  const MissionRequest& mission_;
  const MissionWorld& world_;
  const Plant& plant_;
  const PlanOptions& options_;
  const std::vector<LegState>& states_;
  Pose here_;
  bool moved_{};
  EffectMemory memory_{};
  PreparedLegs prepared_{};
};

}  // namespace

std::string goal_name(const LegRequest& leg) {
  if (leg.motion) return "motion";
  return leg.to.empty() ? "path" : leg.to;
}

Plan infeasible(Plan plan, std::size_t leg, double arc_length_m, Infeasibility reason) {
  plan.status = SolveStatus::infeasible;
  plan.message = reason.message.empty() ? sentence(reason) : reason.message;
  plan.infeasibility = {.reason = std::move(reason), .leg = leg, .arc_length_m = arc_length_m};
  return plan;
}

Plan failed(Plan plan, std::string reason) {
  plan.status = SolveStatus::failed;
  plan.message = std::move(reason);
  return plan;
}

PreparedLegs prepare_legs(const MissionRequest& mission, const MissionWorld& world, const Plant& plant,
                          const PlanOptions& options, const std::vector<LegState>& states,
                          std::vector<LegPath> paths, Plan& plan) {
  LegPreparation preparation(mission, world, plant, options, states);
  for (std::size_t k = 0; k < mission.legs.size() && k < paths.size(); ++k)
    if (auto reason = preparation.add(k, std::move(paths[k]))) {
      const double s_m = reason->s;
      plan = infeasible(std::move(plan), k, s_m, std::move(*reason));
      break;
    }
  return std::move(preparation).legs();
}

void check_end_speeds(const PreparedLegs& prepared, const MissionRequest& mission) {
  for (std::size_t k = 0; k < prepared.timing.size(); ++k) {
    const LegRequest& leg = mission.legs[k];
    const std::vector<ProfileRequest>& stretches = prepared.timing[k].stretches();
    if (leg.motion) continue;
    if (leg.start_speed_m_s > 0 && (stretches.empty() || is_turn(stretches.front().piece)))
      refuse_speed(leg, "start_speed_m_s", leg.start_speed_m_s,
                   "0 m/s where a leg begins with a turn in place or does not drive");
    if (leg.end_speed_m_s > 0 && (stretches.empty() || is_turn(stretches.back().piece)))
      refuse_speed(leg, "end_speed_m_s", leg.end_speed_m_s,
                   "0 m/s where a leg ends with a turn in place or does not drive");
  }
}

bool all_driven(std::size_t leg, const PreparedLegs& prepared, const std::vector<ProfileResult>& results,
                Plan& plan) {
  const std::vector<ProfileRequest>& stretches = prepared.timing[leg].stretches();
  double offset_m = 0.0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const bool turns = is_turn(stretches[k].piece);
    if (!results[k].profile) {
      if (results[k].infeasibility)
        plan = infeasible(std::move(plan), leg, offset_m + (turns ? 0.0 : results[k].infeasibility->s),
                          *results[k].infeasibility);
      else
        plan = failed(std::move(plan),
                      "leg " + leg_text(leg, prepared.legs[leg].to) + ": " + results[k].summary.message);
      return false;
    }
    if (!turns) offset_m += piece_length(stretches[k].piece);
  }
  return true;
}

bool check_each_leg(PreparedLegs& prepared, double price_W, SolverChoice solver, Plan& plan) {
  for (std::size_t leg = 0; leg < prepared.timing.size(); ++leg)
    if (!all_driven(leg, prepared, prepared.timing[leg].solve(price_W, solver), plan)) return false;
  return true;
}

}  // namespace joulepath
