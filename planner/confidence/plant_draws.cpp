#include "planner/confidence/plant_draws.hpp"

#include <utility>

#include "planner/accounts/stretch_account.hpp"

namespace joulepath {
namespace {

constexpr double kLeastShare = 0.05;

}  // namespace

PlantDraws::PlantDraws(const Plant& plant, std::uint64_t seed)
    : plant_(plant),
      nuisances_(nuisances_of(plant.robot)),
      factor_(cholesky_factor(nuisance_correlation(plant.robot)).value()),
      random_(seed) {}

std::vector<double> PlantDraws::sigmas() {
  std::vector<double> sigmas;
  const auto is_too_low = [&] {
    for (std::size_t i = 0; i < nuisances_.size(); ++i)
      if (1 + nuisances_[i].sigma * sigmas[i] < kLeastShare) return true;
    return false;
  };
  do {
    Eigen::VectorXd independent(static_cast<Eigen::Index>(nuisances_.size()));
    for (double& value : independent) value = normal_(random_);
    const Eigen::VectorXd correlated = factor_ * independent;
    sigmas.assign(correlated.begin(), correlated.end());
  } while (is_too_low());
  return sigmas;
}

PlantDraw PlantDraws::next() {
  PlantDraw draw{.plant = plant_, .sigmas = sigmas()};
  for (std::size_t i = 0; i < nuisances_.size(); ++i)
    draw.plant = with_error(std::move(draw.plant), nuisances_[i], nuisances_[i].sigma * draw.sigmas[i]);
  draw.sigmas.push_back(normal_(random_));
  return draw;
}

}  // namespace joulepath
