#include "planner/mission/prepared_legs.hpp"

#include <algorithm>
#include <cmath>

#include "model/config_error.hpp"
#include "model/limit_table.hpp"
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

}  // namespace

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
                          const PlanOptions& options, std::vector<LegPath> paths, Plan& plan) {
  PreparedLegs prepared;
  Pose here = mission.start.pose;
  EffectMemory memory{};
  for (std::size_t k = 0; k < mission.legs.size() && k < paths.size(); ++k) {
    const LegRequest& leg = mission.legs[k];
    check_joint(mission, k);
    if (auto reason = payload_too_heavy(world.robot, leg, here)) {
      plan = infeasible(std::move(plan), k, 0.0, std::move(*reason));
      return prepared;
    }
    LegPath& way = paths[k];
    if (way.infeasibility) {
      const double s_m = way.infeasibility->s;
      plan = infeasible(std::move(plan), k, s_m, std::move(*way.infeasibility));
      return prepared;
    }
    if (leg.motion) {
      prepared.timing.emplace_back(std::vector<ProfileRequest>{});
      prepared.legs.push_back(prescribed_leg(leg, plant, here));
      prepared.legs.back().memory = memory;
      if (auto reason = broken_limit(prepared.legs.back(), k, mission, world, plant)) {
        plan = infeasible(std::move(plan), k, reason->s, std::move(*reason));
        return prepared;
      }
      const double end_s = prepared.legs.back().prescribed->time_s.back();
      here = sampled_state(*prepared.legs.back().prescribed, end_s).pose;
      memory = prescribed_motion(prepared.legs.back(), plant).memory(end_s);
      continue;
    }
    prepared.timing.emplace_back(stretches_of(way.path, leg, k, mission, world, plant, options, memory),
                                 options.answers);
    prepared.legs.push_back({.to = leg.to.empty() ? "path" : leg.to,
                             .path_source = way.source,
                             .payload = leg.payload,
                             .parts = leg.parts,
                             .memory = memory,
                             .dwell_s = leg.dwell_s,
                             .distance_m = way.path.distance_m(),
                             .turned_rad = way.path.turned_rad(),
                             .charger_W = leg.charges ? mission.stations.at(leg.to).charger_W : 0.0,
                             .alternatives = std::move(way.alternatives),
                             .improvements = std::move(way.improvements)});
    if (way.path.pieces.empty()) continue;
    here = way.path.end();
    memory = memory_after(prepared.timing.back().stretches().back());
  }
  return prepared;
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

bool all_driven(std::size_t leg, const std::vector<ProfileRequest>& stretches,
                const std::vector<ProfileResult>& results, Plan& plan) {
  double offset_m = 0.0;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const bool turns = is_turn(stretches[k].piece);
    if (!results[k].profile) {
      if (results[k].infeasibility)
        plan = infeasible(std::move(plan), leg, offset_m + (turns ? 0.0 : results[k].infeasibility->s),
                          *results[k].infeasibility);
      else
        plan = failed(std::move(plan), "leg " + std::to_string(leg) + ": " + results[k].summary.message);
      return false;
    }
    if (!turns) offset_m += piece_length(stretches[k].piece);
  }
  return true;
}

bool check_each_leg(PreparedLegs& prepared, double price_W, SolverChoice solver, Plan& plan) {
  for (std::size_t leg = 0; leg < prepared.timing.size(); ++leg)
    if (!all_driven(leg, prepared.timing[leg].stretches(), prepared.timing[leg].solve(price_W, solver), plan))
      return false;
  return true;
}

}  // namespace joulepath
