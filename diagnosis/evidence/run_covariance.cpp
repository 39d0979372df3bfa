#include "diagnosis/evidence/run_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {

Eigen::MatrixXd run_covariance(const Equations& equations, const std::vector<std::size_t>& runs,
                               const std::vector<int>& columns, const Eigen::VectorXd& parameters,
                               const Eigen::MatrixXd& covariance, double dispersion) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index p = parameters.size();
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t r : runs) {
    const Eigen::MatrixXd& gram = equations.runs[r].gram;
    const Eigen::VectorXd all = gram.topRightCorner(p, 1) - gram.topLeftCorner(p, p) * parameters;
    Eigen::VectorXd score(n);
    for (Eigen::Index i = 0; i < n; ++i) score[i] = all[columns[static_cast<std::size_t>(i)]] / dispersion;
    middle += score * score.transpose();
  }
  const auto count = static_cast<double>(runs.size());
  middle *= count / std::max(1.0, count - 1);
  for (Eigen::Index i = 0; i < n; ++i)
    middle(i, i) += 1 / std::pow(equations.prior_sd[columns[static_cast<std::size_t>(i)]], 2);
  return covariance * middle * covariance;
}

}  // namespace joulepath
