#include "planner/confidence/plan_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/accounts/stretch_account.hpp"

namespace joulepath {

PlanDemands::PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ChargeStates& charge)
    : robot_(robot),
      plant_(plant),
      charge_(charge),
      energy_(plan, plant),
      model_friction_Nm_(model_friction_Nm(robot.model_energy_sigma().value_or(0.0))),
      forces_(plan, robot, plant, shifted(), error_factor(plant.robot)) {
  if (!std::isfinite(robot.battery.capacity_Wh)) return;
  const ShiftedPlants plants = shifted();
  fraction_ = energy_.least_fraction(plant, charge_);
  fraction_per_sigma_.resize(static_cast<Eigen::Index>(plants.size()));
  for (std::size_t i = 0; i < plants.size(); ++i)
    fraction_per_sigma_[static_cast<Eigen::Index>(i)] =
        0.5 * (energy_.least_fraction(plants[i][0], charge_) - energy_.least_fraction(plants[i][1], charge_));
}

double PlanDemands::model_friction_Nm(double sigma) const {
  if (sigma == 0) return 0.0;
  constexpr double kShare = 0.01, kSmall_Nm = 0.1;  // of the friction, and that of a small wheel without any
  const auto& [left, right] = plant_.robot.motor;
  const double step_Nm = kShare * std::max({left.friction_torque_Nm, right.friction_torque_Nm, kSmall_Nm});
  Plant rougher = plant_;
  for (const Side side : kSides) rougher.robot.motor[side].friction_torque_Nm += step_Nm;
  const double motion_J = energy_.motion_J(plant_), more_J = energy_.motion_J(rougher) - motion_J;
  return more_J > 0 ? step_Nm * sigma * std::abs(motion_J) / more_J : 0.0;
}

Plant PlanDemands::with_model_error(Plant plant, double sigmas) const {
  constexpr double kLeastShare = 0.05;  // friction never drives the robot
  for (const Side side : kSides) {
    double& friction_Nm = plant.robot.motor[side].friction_torque_Nm;
    friction_Nm = std::max(kLeastShare * friction_Nm, friction_Nm + sigmas * model_friction_Nm_);
  }
  return plant;
}

ShiftedPlants PlanDemands::shifted() const {
  ShiftedPlants plants = uncertain(plant_).shifted;
  plants.push_back({with_model_error(plant_, 1), with_model_error(plant_, -1)});
  return plants;
}

double PlanDemands::estimated_fraction(const Eigen::VectorXd& sigmas) const {
  return fraction_per_sigma_.size() > 0 ? fraction_ + fraction_per_sigma_.dot(sigmas) : fraction_;
}

std::vector<PlanDemand> PlanDemands::estimate(const Eigen::MatrixXd& sigmas) const {
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.estimate(sigmas))
    demands.push_back({use, estimated_fraction(sigmas.col(std::ssize(demands)))});
  return demands;
}

std::vector<PlanDemand> PlanDemands::of(const Eigen::MatrixXd& sigmas, const PlantDraws& draws) const {
  constexpr double kDoubt = 0.5;  // of the change by derivatives: what it may be wrong by
  std::vector<Plant> plants;
  for (const auto& column : sigmas.colwise()) plants.push_back(plant_of(draws.draw_of(column)));
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.of(plants, sigmas)) {
    const Plant& plant = plants[demands.size()];
    PlanDemand& demand = demands.emplace_back(use, estimated_fraction(sigmas.col(std::ssize(demands))));
    if (demand.least_fraction - kDoubt * std::abs(demand.least_fraction - fraction_) <
        robot_.battery.reserve_fraction)
      demand.least_fraction = energy_.least_fraction(plant, charge_);
  }
  return demands;
}

}  // namespace joulepath
