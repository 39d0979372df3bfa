#include <cmath>

#include "benchmarks/paper/sections.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath::bench {
namespace {

constexpr double kPayload_kg = 5.7;

/// A model for planning; the energy is always that of the full model.
struct PlanningModel {
  const char* name;
  Robot robot;
};

/// Eqs. (31), (32) hold wheel by wheel on a straight line. Used on a curve they give each wheel the load
/// J q'' of its own acceleration: this is the full model with I = m l^2, payload included.
Robot polynomial_robot(Robot robot) {
  const double l2 = robot.geometry.half_track_m * robot.geometry.half_track_m;
  robot.inertia.chassis_yaw_inertia_kg_m2 =
      robot.inertia.chassis_mass_kg * l2 - 2 * robot.inertia.wheel_diameter_inertia_kg_m2;
  robot.inertia.payload_yaw_inertia_m2 = l2;
  return robot;
}

/// No load: the motor accelerates its own and the wheel's inertia against friction, not the robot's mass.
Robot unloaded_robot(Robot robot) {
  robot.inertia.chassis_mass_kg = robot.inertia.wheel_mass_kg = 1e-9;
  robot.inertia.chassis_yaw_inertia_kg_m2 = robot.inertia.payload_yaw_inertia_m2 = 1e-9;
  robot.inertia.wheel_diameter_inertia_kg_m2 = 1e-9;
  return robot;
}

struct Task {
  std::string name{};
  PathPiece piece;
};

ProfileRequest request_for(const Task& task, const Robot& robot, double payload_kg, const TimeGoal& goal) {
  ProfileRequest request{.piece = task.piece, .plant = make_nominal_plant(robot)};
  request.limits = {.speed_m_s = 1.0,
                    .acceleration_m_s2 = 0.5,
                    .deceleration_m_s2 = 0.5,
                    .lateral_acceleration_m_s2 = 0.5,
                    .yaw_rate_rad_s = 2.0,
                    .yaw_acceleration_rad_s2 = 2.0};
  request.payload = {payload_kg, payload_kg};
  request.time = goal;
  request.solver = SolverChoice::fast;
  return request;
}

/// Energy of a model's plan by the full model; NaN if there is no plan.
struct Planned {
  double energy_J{};
  double duration_s{};
};

Planned planned_with(const Task& task, const Robot& full, const Robot& model, bool carries_load,
                     const TimeGoal& goal) {
  const ProfileResult result =
      solve_profile(request_for(task, model, carries_load ? kPayload_kg : 0.0, goal));
  if (!result.profile) return {std::nan(""), std::nan("")};
  const ProfileRequest truth = request_for(task, full, kPayload_kg, goal);
  const PathMotion motion = path_motion(truth);
  return {energy_by_cause(motion, *result.profile).total_J(), result.profile->duration_s()};
}

double least_time_s(const Task& task, const Robot& full) {
  const ProfileResult result =
      solve_profile(request_for(task, full, kPayload_kg, {.mode = TimeMode::minimum_time}));
  return result.profile ? result.profile->duration_s() : std::nan("");
}

void row(PaperReport& report, const Task& task, const Robot& full, const std::string& when,
         const TimeGoal& goal) {
  const Planned best = planned_with(task, full, full, true, goal);
  const Planned polynomial = planned_with(task, full, polynomial_robot(full), true, goal);
  const Planned unloaded = planned_with(task, full, unloaded_robot(full), false, goal);
  report.text += text("| %s | %s | %.2f s, %.3f | %.2f s, %+.3f (%+.2f %%) | %.2f s, %+.3f (%+.2f %%) |\n",
                      task.name.c_str(), when.c_str(), best.duration_s, best.energy_J, polynomial.duration_s,
                      polynomial.energy_J - best.energy_J, 100 * (polynomial.energy_J / best.energy_J - 1),
                      unloaded.duration_s, unloaded.energy_J - best.energy_J,
                      100 * (unloaded.energy_J / best.energy_J - 1));
}

}  // namespace

void planning_cost_section(PaperReport& report) {
  Robot full = report.robot;
  full.power.standby_W = 10;
  const Pose origin{};
  const auto curve = [](double size, double bend) {
    return Curve(
        {BezierSegment({{{0, 0}, {2.7 * size, 0}, {2.7 * size, 0}, {2.7 * size, bend * 2.7 * size}}})});
  };
  const std::vector<Task> tasks{{"straight, 10 m", straight_piece(origin, 10.0)},
                                {"straight, 2 m", straight_piece(origin, 2.0)},
                                {"the paper's curve", curve(1.0, 1.0)},
                                {"half of that size", curve(0.5, 1.0)},
                                {"a quarter of that size", curve(0.25, 1.0)}};
  report.text += text(
      "## Beyond the paper: Eqs. 31, 32 as the planning cost\n\nLeast-energy speed profiles from rest to "
      "rest, "
      "%.1f kg on board, planned with three models and charged with the full one (standby 10 W and no "
      "recuperation, both ASSUMED): (1) the full model; (2) Eqs. 31, 32 wheel by wheel, which is the full "
      "model "
      "with I = m l^2 - on a straight line the same thing; (3) a motor model without load torque: friction, "
      "copper and the inertia of motor and wheel, the robot's mass left out. Times: fixed at a multiple of "
      "the "
      "least time T_min, and free (standby against motion). Limits: 1 m/s, 0.5 m/s^2 along and across, 2 "
      "rad/s, "
      "2 rad/s^2.\n\n| path | time | full: time, J | Eqs. 31, 32: time, J lost | without load: time, J lost "
      "|\n"
      "|---|---|---|---|---|\n",
      kPayload_kg);
  for (const Task& task : tasks) {
    const double least_s = least_time_s(task, full);
    for (double factor : {1.1, 1.5, 2.5})
      row(report, task, full, text("%.1f T_min", factor),
          {.mode = TimeMode::fixed_time, .duration_s = factor * least_s});
    row(report, task, full, "free", {.mode = TimeMode::free_time});
  }
  report.text += "\n";
}

}  // namespace joulepath::bench
