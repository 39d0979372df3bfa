#include "planner/confidence/plant_draws.hpp"

#include <utility>

#include "planner/accounts/stretch_account.hpp"

namespace joulepath {

std::vector<std::size_t> uncertain_effects(const Robot& robot) {
  std::vector<std::size_t> uncertain;
  for (std::size_t k = 0; k < robot.effects.size(); ++k)
    if (robot.effects[k].probability < 1) uncertain.push_back(k);
  return uncertain;
}

Plant plant_without(Robot robot, const std::vector<std::size_t>& effects) {
  for (auto k = effects.rbegin(); k != effects.rend(); ++k)
    robot.effects.erase(robot.effects.begin() + static_cast<std::ptrdiff_t>(*k));
  return make_plant(robot);
}

Eigen::MatrixXd error_factor(const Robot& robot) {
  const Eigen::MatrixXd of_constants = cholesky_factor(nuisance_correlation(robot)).value();
  const Eigen::Index count = of_constants.rows() + 1 + std::ssize(uncertain_effects(robot));
  Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(count, count);
  factor.topLeftCorner(of_constants.rows(), of_constants.cols()) = of_constants;
  return factor;
}

PlantDraws::PlantDraws(const Robot& robot, const Plant& plant, std::uint64_t seed)
    : robot_(robot),
      plant_(plant),
      nuisances_(nuisances_of(plant.robot)),
      uncertain_effects_(uncertain_effects(robot)),
      factor_(error_factor(robot)),
      random_(seed) {}

bool PlantDraws::is_too_low(const Eigen::VectorXd& errors) const {
  for (std::size_t i = 0; i < nuisances_.size(); ++i)
    if (1 + nuisances_[i].sigma * errors[static_cast<Eigen::Index>(i)] < kLeastShare) return true;
  return false;
}

Eigen::VectorXd PlantDraws::next_errors() {
  const Eigen::Index count = std::ssize(nuisances_);
  Eigen::VectorXd independent(count), errors(factor_.rows());
  do {
    for (double& value : independent) value = normal_(random_);
    errors.head(count) = factor_.topLeftCorner(count, count) * independent;
  } while (is_too_low(errors));
  Eigen::Index at = count;
  errors[at++] = normal_(random_);
  for (const std::size_t effect : uncertain_effects_)
    errors[at++] = uniform_(random_) < robot_.effects[effect].probability ? 0 : kLacking;
  return errors;
}

Eigen::MatrixXd PlantDraws::next_errors(std::size_t draws) {
  Eigen::MatrixXd errors(factor_.rows(), draws);
  for (auto column : errors.colwise()) column = next_errors();
  return errors;
}

PlantDraw PlantDraws::draw_of(const Eigen::VectorXd& errors) const {
  std::vector<std::size_t> lacking;
  for (std::size_t k = 0; k < uncertain_effects_.size(); ++k)
    if (errors[std::ssize(nuisances_) + 1 + static_cast<Eigen::Index>(k)] > 0)
      lacking.push_back(uncertain_effects_[k]);
  PlantDraw draw{.plant = lacking.empty() ? plant_ : plant_without(robot_, lacking), .errors = errors};
  for (std::size_t i = 0; i < nuisances_.size(); ++i)
    draw.plant = with_error(std::move(draw.plant), nuisances_[i],
                            nuisances_[i].sigma * errors[static_cast<Eigen::Index>(i)]);
  return draw;
}

}  // namespace joulepath
