#include "scenarios/result_files/decision_cost.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/parallel.hpp"
#include "model/limit_table.hpp"
#include "model/progress.hpp"
#include "planner/mission/mission.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

const BezierPoints kStraight{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}};
const BezierPoints kQuarterTurn{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}};  // [P1, Eq. (34)]
constexpr std::size_t kNodes = 80;

Robot with_limits(Robot robot) {
  if (!robot.limits)
    robot.limits = Limits{
        .speed_m_s = 1.0, .acceleration_m_s2 = 0.5, .deceleration_m_s2 = 0.5, .yaw_acceleration_rad_s2 = 1.0};
  robot.battery.capacity_Wh = kNoLimit;  // compare energy, not range
  robot.uncertainty.clear();             // uncertainty does not enter the comparison
  return robot;
}

MissionRequest mission_along(const BezierPoints& curve, double payload_kg) {
  LegRequest leg{.path = PathRequest{.bezier_m = {curve}}, .payload = {payload_kg, payload_kg}};
  return {.name = "decision", .legs = {leg}};
}

/// Energy of a planned motion on a plant, for the same path and the same times.
double energy_on(const Plant& plant, const Plan& plan) {
  double energy_J = 0.0;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      ProfileRequest request = stretch.request;
      request.plant = plant;
      energy_J += energy_by_cause(path_motion(request), stretch.profile).total_J();
    }
  return energy_J;
}

}  // namespace

DecisionCost decision_cost(const Robot& nominal, const Robot& corrected) {
  return decision_cost(nominal, corrected, corrected);
}

DecisionCost decision_cost(const Robot& nominal, const Robot& corrected, const Robot& driven) {
  const Plant plant = make_plant(with_limits(driven));
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = kNodes, .baselines = false};
  const double half_load_kg = 0.5 * std::min(10.0, payload_limit_kg(with_limits(nominal)));
  const std::vector<MissionRequest> missions{
      mission_along(kStraight, 0.0), mission_along(kStraight, half_load_kg), mission_along(kQuarterTurn, 0.0),
      mission_along(kQuarterTurn, half_load_kg)};
  // Even entries: plans of the nominal robot; odd entries: of the corrected robot. Joules on the driven
  // plant.
  std::vector<double> energy_J(2 * missions.size());
  const StepScope uncounted(nullptr);
  parallel_for(energy_J.size(), [&](std::size_t k) {
    const Robot& robot = k % 2 == 0 ? nominal : corrected;
    energy_J[k] = energy_on(plant, plan_mission(missions[k / 2], {.robot = with_limits(robot)}, options));
  });
  DecisionCost cost;
  double nominal_J = 0.0, corrected_J = 0.0;
  for (std::size_t m = 0; m < missions.size(); ++m) {
    if (energy_J[2 * m] == 0 || energy_J[2 * m + 1] == 0) continue;  // no plan
    ++cost.missions;
    nominal_J += energy_J[2 * m];
    corrected_J += energy_J[2 * m + 1];
  }
  if (nominal_J > 0) cost.joules_lost_percent = 100.0 * (nominal_J - corrected_J) / nominal_J;
  return cost;
}

}  // namespace joulepath
