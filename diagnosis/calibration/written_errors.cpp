#include "diagnosis/calibration/written_errors.hpp"

#include <algorithm>
#include <cmath>

#include "model/nuisance_correlation.hpp"

namespace joulepath::calibration {
namespace {

/// Correlations of stated constants with each other, as the robot file has them.
Eigen::MatrixXd stated_correlations(const Robot& robot, const std::vector<std::string>& keys) {
  Eigen::MatrixXd matrix(std::ssize(keys), std::ssize(keys));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index k = 0; k < matrix.cols(); ++k)
      matrix(i, k) = i == k ? 1.0
                            : stated_correlation(robot, keys[static_cast<std::size_t>(i)],
                                                 keys[static_cast<std::size_t>(k)]);
  return matrix;
}

/// Relative deviation of a value that was seen, else 0.
double relative_deviation(const CalibratedParameter& value) {
  const bool written = value.visibility != Visibility::unseen && value.value > 0;
  return written && value.standard_deviation > 0 ? value.standard_deviation / value.value : 0.0;
}

}  // namespace

FittedErrors with_inherited(const Robot& robot, const Eigen::MatrixXd& covariance,
                            const Eigen::MatrixXd& changes, std::vector<std::string> stated) {
  const Eigen::MatrixXd between = stated_correlations(robot, stated);
  const Eigen::Index fitted = covariance.rows(), size = fitted + between.rows();
  Eigen::MatrixXd all(size, size);
  all << covariance + changes * between * changes.transpose(), changes * between,
      between * changes.transpose(), between;
  FittedErrors errors{.stated = std::move(stated), .correlation = correlation_of(all)};
  for (Eigen::Index k = 0; k < fitted; ++k) errors.deviation.push_back(std::sqrt(all(k, k)));
  return errors;
}

void write_errors(const std::vector<CalibratedParameter>& values, const std::vector<WrittenKey>& keys,
                  const FittedErrors& errors, Robot& robot) {
  std::vector<std::string> written;
  Sided<std::vector<std::size_t>> rows;
  for (const auto& [key, value] : keys) {
    const double sigma =
        std::max(relative_deviation(values[value.left]), relative_deviation(values[value.right]));
    if (!(sigma > 0)) continue;
    state_sigma(key, sigma, robot);
    written.push_back(key);
    for (const Side side : kSides) rows[side].push_back(value[side]);
  }
  if (errors.correlation.size() == 0) return;
  for (std::size_t k = 0; k < errors.stated.size(); ++k) {
    written.push_back(errors.stated[k]);
    for (const Side side : kSides) rows[side].push_back(errors.deviation.size() + k);
  }
  const Eigen::MatrixXd& all = errors.correlation;
  state_correlations(written, 0.5 * (all(rows.left, rows.left) + all(rows.right, rows.right)), robot);
}

}  // namespace joulepath::calibration
