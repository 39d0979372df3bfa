#include "planner/confidence/plan_demands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/accounts/stretch_account.hpp"

namespace joulepath {

PlanDemands::PlanDemands(const Plan& plan, const Robot& robot, const Plant& plant, const ChargeStates& charge)
    : robot_(robot),
      plant_(plant),
      charge_(charge),
      energy_(plan, plant),
      model_error_(std::ssize(nuisances_of(plant.robot))),
      model_friction_Nm_(model_friction_Nm(robot.model_energy_sigma().value_or(0.0))),
      errors_{shifted(1), shifted(kReach), uncertain_effects(robot).size(), error_factor(robot)},
      forces_(plan, robot, plant, errors_) {
  if (!std::isfinite(robot.battery.capacity_Wh)) return;
  const auto fraction = [&](const Plant& other) { return energy_.least_fraction(other, charge_); };
  fraction_ = fraction(plant);
  fraction_per_sigma_.resize(std::ssize(errors_.near));
  fall_per_sigma_.resize(std::ssize(errors_.near), 2);
  for (std::size_t i = 0; i < errors_.near.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    std::array<double, 2> near{};
    for (const std::size_t side : {0, 1}) {
      near[side] = fraction(errors_.near[i][side]);
      const double far = fraction(errors_.far[i][side]);
      fall_per_sigma_(row, static_cast<Eigen::Index>(side)) =
          std::max({0.0, fraction_ - near[side], (fraction_ - far) / kReach});
    }
    fraction_per_sigma_[row] = 0.5 * (near[0] - near[1]);
  }
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
  for (const Nuisance& nuisance : nuisances_of(plant_.robot)) {
    const double more = sigmas * nuisance.sigma;
    plants.push_back(
        {with_error(plant_, nuisance, more), with_error(plant_, nuisance, std::max(-more, kLeastShare - 1))});
  }
  plants.push_back({with_model_error(plant_, sigmas), with_model_error(plant_, -sigmas)});
  for (const std::size_t effect : uncertain_effects(robot_))
    plants.push_back({plant_without(robot_, {effect}), plant_});
  return plants;
}

double PlanDemands::estimated_fraction(const Eigen::VectorXd& errors) const {
  return fraction_per_sigma_.size() > 0 ? fraction_ + fraction_per_sigma_.dot(errors) : fraction_;
}

std::vector<PlanDemand> PlanDemands::estimate(const Eigen::MatrixXd& errors) const {
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.estimate(errors))
    demands.push_back({use, estimated_fraction(errors.col(std::ssize(demands)))});
  return demands;
}

std::vector<PlanDemand> PlanDemands::of(const Eigen::MatrixXd& errors, const PlantDraws& draws) const {
  constexpr double kTogether = 1.5;  // of the falls by one error each: errors act together
  std::vector<Plant> plants;
  for (const auto& column : errors.colwise()) plants.push_back(plant_of(draws.draw_of(column)));
  std::vector<PlanDemand> demands;
  for (const ForceUses& use : forces_.of(plants, errors)) {
    const Plant& plant = plants[demands.size()];
    const Eigen::VectorXd of_draw = errors.col(std::ssize(demands));
    PlanDemand& demand = demands.emplace_back(PlanDemand{use, estimated_fraction(of_draw)});
    if (fraction_per_sigma_.size() == 0) continue;
    const double fall =
        fall_per_sigma_.col(0).dot(of_draw.cwiseMax(0.0)) - fall_per_sigma_.col(1).dot(of_draw.cwiseMin(0.0));
    if (!(fraction_ - kTogether * fall >= robot_.battery.reserve_fraction))
      demand.least_fraction = energy_.least_fraction(plant, charge_);
  }
  return demands;
}

}  // namespace joulepath
