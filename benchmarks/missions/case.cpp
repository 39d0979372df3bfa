#include "benchmarks/missions/case.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "planner/accounts/plan_trajectory.hpp"
#include "planner/baselines/baseline.hpp"

namespace joulepath::bench {
namespace {

constexpr double kEulerStep_s = 0.5;
constexpr double kRoom = 1.05;  ///< over the fastest drive of the leg that a split by length gives least
constexpr WaySteps kPlain{.corners = false, .routes = false, .stops = false, .refinement = false};

bool drives(const Plan& plan) {
  return plan.status == SolveStatus::optimal || plan.status == SolveStatus::feasible;
}

/// mass |a| v + rolling force v in half-second Euler steps; the rolling force is the robot's own friction.
double simple_fleet_model_J(const Trajectory& motion, const Robot& robot) {
  const double mass_kg = robot.inertia.chassis_mass_kg + 2 * robot.inertia.wheel_mass_kg;
  const double force_N = robot.motor.left.friction_torque_Nm / robot.geometry.wheel_radius_m.left +
                         robot.motor.right.friction_torque_Nm / robot.geometry.wheel_radius_m.right;
  double sum_J = 0.0, due_s = 0.0;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    if (motion.time_s[k] < due_s - 1e-9) continue;
    due_s += kEulerStep_s;
    const double force =
        (mass_kg + motion.payload_kg[k]) * std::abs(motion.linear_acceleration_m_s2[k]) + force_N;
    sum_J += kEulerStep_s * force * std::abs(motion.linear_speed_m_s[k]);
  }
  return sum_J;
}

/// Plans one mission in several ways.
class CasePlanner {
 public:
  CasePlanner(const Floor& floor, std::mt19937& random)
      : floor_(floor), drawn_(random_mission(floor, random)), without_standby_(floor.world) {
    without_standby_.robot.power.standby_W = 0.0;
  }

  std::optional<Case> run() {
    const std::vector<LegRequest> given = drawn_.legs_in({0, 1, 2, 3});
    MissionRequest visits = drawn_.base;
    visits.visit = drawn_.visit;
    const std::optional<Plan> ordered = plan(visits, kPlain, floor_.world);
    if (!ordered) return std::nullopt;
    const std::vector<LegRequest> better = drawn_.legs_in(ordered->visit->order);
    const std::optional<Plan> plain = split_by_length(given);
    if (!plain) return std::nullopt;
    total_s_ = plain->duration_s;
    const std::optional<Joules> trapezoid = trapezoid_joules(*plain);
    if (!trapezoid) return std::nullopt;
    result_.joules = {{"plain", *trapezoid}, {"profile", joules(*plain)}};

    const double begin_s = cpu_s();
    const std::optional<Plan> together = in_time(drawn_.with(better), {});
    if (!together) return std::nullopt;
    result_.together_cpu_s = cpu_s() - begin_s;
    result_.joules["together"] = joules(*together);
    result_.order_changed = ordered->visit->order != std::vector<std::size_t>{0, 1, 2, 3};
    compare_fleet_model(*together);

    const bool all =
        add("time", drawn_.with(given), kPlain) &&
        add("arcs", drawn_.with(given), {.routes = false, .refinement = false}) &&
        add("routes", drawn_.with(given), {.corners = false, .stops = false, .refinement = false}) &&
        add("refinement", drawn_.with(given), {.routes = false}) && add("order", drawn_.with(better), kPlain);
    return all ? std::optional(result_) : std::nullopt;
  }

 private:
  std::optional<Plan> plan(const MissionRequest& mission, const WaySteps& steps,
                           const MissionWorld& world) const {
    const PlanOptions options{.solver = SolverChoice::fast, .steps = steps, .baselines = false};
    Plan plan = plan_mission(mission, world, options, &floor_.space);
    return drives(plan) ? std::optional(std::move(plan)) : std::nullopt;
  }
  std::optional<Plan> in_time(MissionRequest mission, const WaySteps& steps) const {
    mission.objective.deadline_s = total_s_ * (1 + 1e-9);
    return plan(mission, steps, without_standby_);
  }
  bool add(const std::string& name, const MissionRequest& mission, const WaySteps& steps) {
    const std::optional<Plan> planned = in_time(mission, steps);
    if (planned) result_.joules[name] = joules(*planned);
    return planned.has_value();
  }

  /// The plain mission with its time split over the legs by length: its own optimal time, more if a leg needs
  /// it.
  std::optional<Plan> split_by_length(std::vector<LegRequest> legs) const {
    const std::optional<Plan> free = plan(drawn_.with(legs), kPlain, floor_.world);
    if (!free) return std::nullopt;
    double driving_s = 0.0;
    for (const LegPlan& leg : free->legs) driving_s += leg.duration_s;
    MissionRequest hurried = drawn_.with(legs);
    hurried.objective.minimize = Objective::Minimize::time;
    const std::optional<Plan> fastest = plan(hurried, kPlain, without_standby_);
    if (!fastest) return std::nullopt;
    double factor = 1.0;
    for (std::size_t k = 0; k < legs.size(); ++k) {
      legs[k].duration_s = driving_s * free->legs[k].distance_m / free->distance_m;
      factor = std::max(factor, kRoom * fastest->legs[k].duration_s / *legs[k].duration_s);
    }
    for (LegRequest& leg : legs) *leg.duration_s *= factor;
    return plan(drawn_.with(legs), kPlain, without_standby_);
  }

  Joules joules(const Plan& plan) const { return in_total(plan.energy.motion_J()); }
  Joules in_total(double motion_J) const {
    return {motion_J + floor_.world.robot.power.standby_W * total_s_, motion_J};
  }
  std::optional<Joules> trapezoid_joules(const Plan& plan) const {
    double motion_J = 0.0;
    for (const LegPlan& leg : plan.legs)
      for (const StretchPlan& stretch : leg.stretches) {
        const BaselineResult result =
            trapezoid_max_acceleration(stretch.request, stretch.profile.duration_s());
        if (!result.feasible) return std::nullopt;
        motion_J += result.motion_energy_J;
      }
    return in_total(motion_J);
  }
  void compare_fleet_model(const Plan& plan) {
    const Robot& robot = floor_.world.robot;
    const double simple_J = simple_fleet_model_J(plan_trajectory(plan, make_plant(robot)), robot);
    const double motion_J = plan.energy.motion_J();
    result_.fleet_motion_percent = 100 * (simple_J / motion_J - 1);
    result_.fleet_percent = 100 * (simple_J - motion_J) / joules(plan).with_standby;
  }

  const Floor& floor_;
  DrawnMission drawn_;
  MissionWorld without_standby_;  ///< in a given total time standby is the same for every plan
  double total_s_{};
  Case result_{};
};

}  // namespace

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::optional<Case> random_case(const Floor& floor, std::mt19937& random) {
  return CasePlanner(floor, random).run();
}

}  // namespace joulepath::bench
