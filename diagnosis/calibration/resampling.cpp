#include "diagnosis/calibration/resampling.hpp"

#include <cmath>

#include "model/progress.hpp"

// Method: [EfronStein1981]
namespace joulepath::calibration {

Resampled jackknife(std::size_t units, const std::function<std::vector<double>(std::size_t)>& estimate) {
  expect_steps(units);
  std::vector<Eigen::VectorXd> all;
  for (std::size_t i = 0; i < units; ++i) {
    const std::vector<double> one = estimate(i);
    all.push_back(Eigen::VectorXd::Map(one.data(), std::ssize(one)));
    finish_steps();
  }
  const auto n = static_cast<double>(units);
  const Eigen::Index size = all.front().size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::VectorXd& one : all) mean += one / n;
  for (const Eigen::VectorXd& one : all) products += (one - mean) * (one - mean).transpose();
  Resampled result{.covariance = (n - 1) / n * products};
  for (Eigen::Index k = 0; k < size; ++k)
    result.standard_deviation.push_back(std::sqrt(result.covariance(k, k)));
  return result;
}

}  // namespace joulepath::calibration
