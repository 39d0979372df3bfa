#pragma once

#include <random>
#include <vector>

#include "model/nuisance_correlation.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// A plant as it may be.
struct PlantDraw {
  Plant plant{};
  Eigen::VectorXd errors{};  ///< in sigmas of nuisances_of(robot), then of the model itself; then kLacking or
                             ///< 0 for each of the uncertain effects
};
inline constexpr double kLeastShare = 0.05;  ///< of a constant that an error leaves
inline constexpr double kLacking = 2;        ///< of an effect, beside errors of one sigma more and less

/// The effects of a robot file that it may lack.
[[nodiscard]] std::vector<std::size_t> uncertain_effects(const Robot& robot);
/// The plant of a robot without some of its effects.
[[nodiscard]] Plant plant_without(Robot robot, const std::vector<std::size_t>& effects);

/// A factor F of the covariance F F' of errors; of lacking effects it is as large as need be.
[[nodiscard]] Eigen::MatrixXd error_factor(const Robot& robot);

/// Plants drawn from the errors that a robot file states (`uncertainty:`), with their correlations. Each
/// error is normal; one that would leave less than a twentieth of a constant is drawn again. The same seed
/// gives the same plants. An effect with a probability below 1 is absent from its share of them, each on its
/// own. The model's own error is a number of sigmas only: what it does depends on the motion (PlanDemands).
/// It keeps references to robot and plant.
class PlantDraws {
 public:
  PlantDraws(const Robot& robot, const Plant& plant, std::uint64_t seed);

  /// Errors of the next draw; of the next ones, a column each.
  [[nodiscard]] Eigen::VectorXd next_errors();
  [[nodiscard]] Eigen::MatrixXd next_errors(std::size_t draws);
  [[nodiscard]] PlantDraw draw_of(const Eigen::VectorXd& errors) const;
  [[nodiscard]] PlantDraw next() { return draw_of(next_errors()); }

 private:
  bool is_too_low(const Eigen::VectorXd& errors) const;

  const Robot& robot_;
  const Plant& plant_;
  std::vector<Nuisance> nuisances_{};
  std::vector<std::size_t> uncertain_effects_{};
  Eigen::MatrixXd factor_{};
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_{};
  std::uniform_real_distribution<double> uniform_{};
};

}  // namespace joulepath
