#pragma once

#include <Eigen/Core>
#include <optional>

#include "model/nuisance.hpp"

namespace joulepath {

/// Correlation matrix of the errors of `nuisances_of(robot)`, in their order, from
/// `uncertainty_correlations:`. A correlation with friction holds for the error of each side. The file states
/// none between left and right: both are independent given the other constants, which is the choice of the
/// greatest entropy, so without correlations of friction they are independent.
/// Pairs whose errors are zero or not stated are left out. For a robot that was read from a file the matrix
/// is positive definite.
[[nodiscard]] Eigen::MatrixXd nuisance_correlation(const Robot& robot);

/// Correlation that the file states for the errors of two keys; 0 where it states none.
[[nodiscard]] double stated_correlation(const Robot& robot, const std::string& one, const std::string& other);

/// Whether an entry of `uncertainty_correlations:` may name the key: a constant of the calibration whose
/// error is stated and not zero. The payload's error is of its weighing and the model's error is what
/// remains beside all constants, so neither is correlated with a constant.
[[nodiscard]] bool may_correlate(const Robot& robot, const std::string& key);

/// Lower triangular L with L L^T = the matrix; nothing where that is not positive definite. The relative
/// errors sigma_i (L z)_i, with independent standard normal z, have this correlation.
[[nodiscard]] std::optional<Eigen::MatrixXd> cholesky_factor(const Eigen::MatrixXd& matrix);

/// What correlations add to the variance of a sum of changes s, one per nuisance at one sigma:
/// s^T C s - s^T s, with the correlation matrix C.
[[nodiscard]] double correlated_variance(const std::vector<double>& shifts,
                                         const Eigen::MatrixXd& correlation);

/// Correlation matrix of a covariance; an error without variance is independent of all.
[[nodiscard]] Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance);

/// Writes a new error of a key into `uncertainty:`: its former correlations are void.
void state_sigma(const std::string& key, double sigma, Robot& robot);

/// Writes the correlations of these keys' errors, instead of those that were stated between them: to two
/// digits, without those below 0.05 and without keys that may have none. Where rounding leaves no positive
/// definite matrix, all of them are smaller by whole percents.
void state_correlations(const std::vector<std::string>& keys, const Eigen::MatrixXd& correlation,
                        Robot& robot);

}  // namespace joulepath
