#include "planner/confidence/plan_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/accounts/stretch_account.hpp"
#include "planner/accounts/winding_account.hpp"

namespace joulepath {

std::string used_limit_name(std::size_t i) {
  return i == kWindingLimit ? kWindingTemperature : std::string(force_limits()[i]->name);
}

PlanDemands::PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ChargeStates& charge)
    : robot_(robot),
      plant_(plant),
      courses_(plan, plant, charge),
      nominal_{plant, courses_.of(plant)},
      model_error_(std::ssize(nuisances_of(plant.robot))),
      model_friction_Nm_(model_friction_Nm(robot.model_energy_sigma().value_or(0.0))),
      errors_{shifted(1), shifted(kReach), uncertain_effects(robot).size(), error_factor(robot)},
      forces_(plan, robot, nominal_, errors_),
      course_(nominal_.course, errors_, charge.start_fraction, !robot.battery.open_circuit_curve.empty()) {}

PlanDemand PlanDemands::demand(const ForceUses& forces, const PlanCourse& course) {
  PlanDemand demand{.least_fraction = course.least_fraction};
  std::copy(forces.begin(), forces.end(), demand.use.begin());
  demand.use[kWindingLimit] = course.winding_use;
  return demand;
}

double PlanDemands::model_friction_Nm(double sigma) const {
  if (sigma == 0) return 0.0;
  constexpr double kShare = 0.01, kSmall_Nm = 0.1;  // of the friction, and that of a small wheel without any
  const auto& [left, right] = plant_.robot.motor;
  const double step_Nm = kShare * std::max({left.friction_torque_Nm, right.friction_torque_Nm, kSmall_Nm});
  Plant rougher = plant_;
  for (const Side side : kSides) rougher.robot.motor[side].friction_torque_Nm += step_Nm;
  const double motion_J = courses_.motion_J(plant_), more_J = courses_.motion_J(rougher) - motion_J;
  return more_J > 0 ? step_Nm * sigma * std::abs(motion_J) / more_J : 0.0;
}

/// Friction never drives the robot.
Plant PlanDemands::with_model_error(Plant plant, double sigmas) const {
  for (const Side side : kSides) {
    double& friction_Nm = plant.robot.motor[side].friction_torque_Nm;
    friction_Nm = std::max(kLeastShare * friction_Nm, friction_Nm + sigmas * model_friction_Nm_);
  }
  return plant;
}

ShiftedPlants PlanDemands::shifted(double sigmas) const {
  ShiftedPlants plants;
  const auto drawn = [&](const Plant& plant) { return DrawnPlant{plant, courses_.of(plant)}; };
  for (const Nuisance& nuisance : nuisances_of(plant_.robot)) {
    const double more = sigmas * nuisance.sigma;
    plants.push_back({drawn(with_error(plant_, nuisance, more)),
                      drawn(with_error(plant_, nuisance, std::max(-more, kLeastShare - 1)))});
  }
  plants.push_back({drawn(with_model_error(plant_, sigmas)), drawn(with_model_error(plant_, -sigmas))});
  for (const std::size_t effect : uncertain_effects(robot_))
    plants.push_back({drawn(plant_without(robot_, {effect})), nominal_});
  return plants;
}

DrawnPlant PlanDemands::plant_of(const PlantDraw& draw) const {
  return {with_model_error(draw.plant, draw.errors[model_error_]), course_.at(draw.errors).front()};
}

std::vector<PlanDemand> PlanDemands::estimate(const Eigen::MatrixXd& errors) const {
  const std::vector<PlanCourse> courses = course_.at(errors);
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.estimate(errors))
    demands.push_back(demand(use, courses[demands.size()]));
  return demands;
}

std::vector<PlanDemand> PlanDemands::of(const Eigen::MatrixXd& errors, const PlantDraws& draws) const {
  std::vector<DrawnPlant> plants;
  for (const auto& column : errors.colwise()) {
    DrawnPlant& drawn = plants.emplace_back(plant_of(draws.draw_of(column)));
    if (courses_.are_followed() && course_.is_in_doubt(robot_.battery.reserve_fraction, column, drawn.course))
      drawn.course = courses_.of(drawn.plant);
  }
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.of(plants, errors))
    demands.push_back(demand(use, plants[demands.size()].course));
  return demands;
}

}  // namespace joulepath
