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

/// A factor F of the covariance F F' of errors in sigmas: of nuisances_of(robot), then of the model itself.
[[nodiscard]] Eigen::MatrixXd error_factor(const Robot& robot);

/// Plants drawn from the errors that a robot file states (`uncertainty:`), with their correlations. Each
/// error is normal; one that would leave less than a twentieth of a constant is drawn again. The same seed
/// gives the same plants. The model's own error is a number of sigmas only: what it does depends on the
/// motion (PlanDemands).
class PlantDraws {
 public:
  PlantDraws(const Plant& plant, std::uint64_t seed);

  /// Errors of the next draw, in sigmas; of the next ones, a column each.
  [[nodiscard]] Eigen::VectorXd next_sigmas();
  [[nodiscard]] Eigen::MatrixXd next_sigmas(std::size_t draws);
  [[nodiscard]] PlantDraw draw_of(const Eigen::VectorXd& sigmas) const;
  [[nodiscard]] PlantDraw next() { return draw_of(next_sigmas()); }

 private:
  bool is_too_low(const Eigen::VectorXd& sigmas) const;

  const Plant& plant_;
  std::vector<Nuisance> nuisances_{};
  Eigen::MatrixXd factor_{};
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{};
};

}  // namespace joulepath
