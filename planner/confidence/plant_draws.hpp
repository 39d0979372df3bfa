#pragma once

#include <random>
#include <vector>

#include "model/nuisance_correlation.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// A plant as it may be.
struct PlantDraw {
  Plant plant{};
  Eigen::VectorXd sigmas{};  ///< errors in sigmas: of nuisances_of(robot), then of the model itself
};

/// Plants drawn from the errors that a robot file states (`uncertainty:`), with their correlations. Each
/// error is normal; one that would leave less than a twentieth of a constant is drawn again. The same seed
/// gives the same plants. The model's own error is a number of sigmas only: what it does depends on the
/// motion (PlanDemands).
class PlantDraws {
 public:
  PlantDraws(const Plant& plant, std::uint64_t seed);

  /// Errors of the next draw, in sigmas.
  [[nodiscard]] Eigen::VectorXd next_sigmas();
  [[nodiscard]] PlantDraw next();

 private:
  bool is_too_low(const Eigen::VectorXd& sigmas) const;

  const Plant& plant_;
  std::vector<Nuisance> nuisances_{};
  Eigen::MatrixXd factor_{};  ///< of the correlation between the errors
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{};
};

}  // namespace joulepath
