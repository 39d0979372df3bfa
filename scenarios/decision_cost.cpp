#include "scenarios/decision_cost.hpp"

#include <algorithm>
#include <cmath>

#include "planner/mission.hpp"

namespace joulepath {
namespace {

const BezierPoints kStraight{{{0, 0}, {2, 0}, {4, 0}, {6, 0}}};
const BezierPoints kTurn{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}};  // [P1, Eq. (34)]
constexpr std::size_t kNodes = 80;

Robot with_limits(Robot robot) {
  if (!robot.limits)
    robot.limits = Limits{
        .speed_m_s = 1.0, .acceleration_m_s2 = 0.5, .deceleration_m_s2 = 0.5, .yaw_acceleration_rad_s2 = 1.0};
  robot.battery.capacity_Wh = kNoLimit;  // the question is energy, not range
  return robot;
}

MissionRequest mission_along(const BezierPoints& curve, double payload_kg) {
  LegRequest leg{.path = PathRequest{.bezier_m = {curve}}, .payload = {payload_kg, payload_kg}};
  return {.name = "decision", .legs = {leg}};
}

/// Energy that a planned motion takes on a plant, following the same path at the same times.
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
  DecisionCost cost;
  const Plant plant = make_plant(with_limits(corrected));
  const PlanOptions options{.solver = SolverChoice::fast, .nodes = kNodes};
  double nominal_J = 0.0, corrected_J = 0.0;
  for (const BezierPoints& curve : {kStraight, kTurn})
    for (const double payload_kg : {0.0, 0.5 * std::min(10.0, with_limits(nominal).limits->max_payload_kg)}) {
      const MissionRequest mission = mission_along(curve, payload_kg);
      const Plan by_nominal = plan_mission(mission, {.robot = with_limits(nominal)}, options);
      const Plan by_corrected = plan_mission(mission, {.robot = with_limits(corrected)}, options);
      if (by_nominal.legs.empty() || by_corrected.legs.empty()) continue;
      ++cost.missions;
      nominal_J += energy_on(plant, by_nominal);
      corrected_J += energy_on(plant, by_corrected);
    }
  if (corrected_J > 0) cost.joules_lost_percent = 100.0 * (nominal_J - corrected_J) / corrected_J;
  return cost;
}

}  // namespace joulepath
