#pragma once

#include <Eigen/Core>

#include "diagnosis/evidence/refit.hpp"

namespace joulepath {

/// Errors of the robot file's constants after a fit, as shares of the file's values.
struct ConstantErrors {
  std::vector<std::size_t> nuisances{};  ///< indices of the constants
  Eigen::VectorXd deviation{};           ///< at most the file's sigma
  Eigen::MatrixXd correlation{};
};

/// The deviation is the greater of what the noise model and what the runs' differences say; the correlation
/// is that of the noise model, which has full rank.
[[nodiscard]] ConstantErrors constant_errors(const Refit& fitted, const std::vector<Nuisance>& nuisances,
                                             const Robot& file);

/// Writes them into a robot with the constants of a state: sigmas relative to its values, and correlations.
/// Friction has the greater sigma of both sides and the mean of their correlations.
void write_constant_errors(const ConstantErrors& errors, const std::vector<Nuisance>& nuisances,
                           const ModelState& state, Robot& robot);

}  // namespace joulepath
