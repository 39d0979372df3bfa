#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// Covariance of fitted parameters from the differences between runs (sandwich estimator with runs as
/// clusters; [White1980], [LiangZeger1986]): C (n/(n-1) sum s s' + P) C with the fit's covariance C, the
/// score s of each run and the prior's precision P. Valid also where the noise model is wrong.
[[nodiscard]] Eigen::MatrixXd run_covariance(const Equations& equations, const std::vector<std::size_t>& runs,
                                             const std::vector<int>& columns,
                                             const Eigen::VectorXd& parameters,
                                             const Eigen::MatrixXd& covariance, double dispersion);

}  // namespace joulepath
