#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// Covariance of fitted parameters from how runs differ among themselves (sandwich estimator, runs as
/// clusters; White 1980, Liang and Zeger 1986): C (n/(n-1) sum s s' + P) C with the fit's covariance C,
/// each run's score s and the prior's precision P. Holds where the noise model does not.
[[nodiscard]] Eigen::MatrixXd run_covariance(const Equations& equations, const std::vector<std::size_t>& runs,
                                             const std::vector<int>& columns,
                                             const Eigen::VectorXd& parameters,
                                             const Eigen::MatrixXd& covariance, double dispersion);

}  // namespace joulepath
