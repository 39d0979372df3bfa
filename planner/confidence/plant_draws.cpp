#include "planner/confidence/plant_draws.hpp"

#include <utility>

#include "planner/accounts/stretch_account.hpp"

namespace joulepath {
namespace {

constexpr double kLeastShare = 0.05;

}  // namespace

Eigen::MatrixXd error_factor(const Robot& robot) {
  const Eigen::MatrixXd of_constants = cholesky_factor(nuisance_correlation(robot)).value();
  Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(of_constants.rows() + 1, of_constants.cols() + 1);
  factor.topLeftCorner(of_constants.rows(), of_constants.cols()) = of_constants;
  return factor;
}

PlantDraws::PlantDraws(const Plant& plant, std::uint64_t seed)
    : plant_(plant),
      nuisances_(nuisances_of(plant.robot)),
      factor_(error_factor(plant.robot)),
      random_(seed) {}

bool PlantDraws::is_too_low(const Eigen::VectorXd& sigmas) const {
  for (std::size_t i = 0; i < nuisances_.size(); ++i)
    if (1 + nuisances_[i].sigma * sigmas[static_cast<Eigen::Index>(i)] < kLeastShare) return true;
  return false;
}

Eigen::VectorXd PlantDraws::next_sigmas() {
  const auto count = static_cast<Eigen::Index>(nuisances_.size());
  Eigen::VectorXd independent(count), sigmas(count + 1);
  do {
    for (double& value : independent) value = normal_(random_);
    sigmas.head(count) = factor_.topLeftCorner(count, count) * independent;
  } while (is_too_low(sigmas));
  sigmas[count] = normal_(random_);
  return sigmas;
}

Eigen::MatrixXd PlantDraws::next_sigmas(std::size_t draws) {
  Eigen::MatrixXd sigmas(std::ssize(nuisances_) + 1, draws);
  for (auto column : sigmas.colwise()) column = next_sigmas();
  return sigmas;
}

PlantDraw PlantDraws::draw_of(const Eigen::VectorXd& sigmas) const {
  PlantDraw draw{.plant = plant_, .sigmas = sigmas};
  for (std::size_t i = 0; i < nuisances_.size(); ++i)
    draw.plant = with_error(std::move(draw.plant), nuisances_[i],
                            nuisances_[i].sigma * draw.sigmas[static_cast<Eigen::Index>(i)]);
  return draw;
}

}  // namespace joulepath
