#include "app/plan/plan_results.hpp"

#include "app/report/plan_report.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/mission_files/plan_file.hpp"

namespace joulepath {

PlanResults plan_results(MissionRequest mission, MissionWorld world, Plan plan) {
  PlanResults results{.mission = std::move(mission), .world = std::move(world), .plan = std::move(plan)};
  const SolveStatus status = results.plan.status;
  results.valid = status == SolveStatus::optimal || status == SolveStatus::feasible;
  if (results.valid) results.trajectory = plan_trajectory(results.plan, make_plant(results.world.robot));
  results.json = plan_json_text(results.plan, plan_robot(results.world.robot));
  return results;
}

std::string PlanResults::trajectory_text() const { return run_log_text(trajectory); }

std::string PlanResults::profile_text() const {
  const PlanNodes nodes = plan_nodes(plan, make_plant(world.robot));
  return run_log_text(nodes.rows, {{"angular_acceleration_rad_s2", &nodes.angular_acceleration_rad_s2},
                                   {"linear_jerk_m_s3", &nodes.linear_jerk_m_s3}});
}

std::string PlanResults::report(const report::Operation& operation) const {
  return report::plan_report(plan, json, trajectory, mission, world, operation);
}

}  // namespace joulepath
