#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/calibration/calibration.hpp"

namespace joulepath::calibration {

/// Errors of fitted values, and of stated constants of the robot file on which they depend.
struct FittedErrors {
  std::vector<double> deviation{};    ///< of the fitted values; NaN: too few runs
  std::vector<std::string> stated{};  ///< keys of the robot file's `uncertainty:`
  Eigen::MatrixXd correlation{};  ///< of the fitted values, then the stated constants; empty: too few runs
};

/// Of values with this covariance from the fit, beside stated constants that change them so much per sigma (a
/// column each).
[[nodiscard]] FittedErrors with_inherited(const Robot& robot, const Eigen::MatrixXd& covariance,
                                          const Eigen::MatrixXd& changes, std::vector<std::string> stated);

/// Where the errors of a key of the robot file stand among the fitted values.
struct WrittenKey {
  std::string key{};
  Sided<std::size_t> value{};  ///< the same for a constant of both sides
};

/// Writes sigmas and correlations of the keys into the robot: of the values that were seen and are positive.
/// A key has the greater relative deviation of both sides and the mean of their correlations; both sides'
/// matrices are positive definite, and so is their mean.
void write_errors(const std::vector<CalibratedParameter>& values, const std::vector<WrittenKey>& keys,
                  const FittedErrors& errors, Robot& robot);

}  // namespace joulepath::calibration
