#include "model/nuisance_correlation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kLeastPivot = 1e-9;  ///< squared; below it a combination of errors is exact to rounding

/// Sets the entry between two errors of one key so that they are independent given all others.
void make_conditionally_independent(Eigen::Index one, Eigen::Index other, Eigen::MatrixXd& matrix) {
  std::vector<Eigen::Index> rest;
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
    if (k != one && k != other) rest.push_back(k);
  const Eigen::VectorXd with_rest = matrix(rest, one);
  if (with_rest.isZero(0)) return;
  const Eigen::MatrixXd between = matrix(rest, rest);
  matrix(one, other) = matrix(other, one) = with_rest.dot(between.ldlt().solve(with_rest));
}

/// Pairs of a matrix that are worth writing, as files state them.
std::vector<Correlation> rounded_pairs(const std::vector<std::string>& keys, const Eigen::MatrixXd& matrix,
                                       const Robot& robot) {
  constexpr double kLeastWritten = 0.05, kMostWritten = 0.99, kDigits = 100;
  std::vector<Correlation> pairs;
  for (std::size_t k = 0; k < keys.size(); ++k)
    for (std::size_t i = 0; i < k; ++i) {
      const double exact = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
      if (!(std::abs(exact) >= kLeastWritten) || !may_correlate(robot, keys[i]) ||
          !may_correlate(robot, keys[k]))
        continue;
      pairs.push_back(
          {keys[i], keys[k], std::clamp(std::round(kDigits * exact) / kDigits, -kMostWritten, kMostWritten)});
    }
  return pairs;
}

}  // namespace

double stated_correlation(const Robot& robot, const std::string& one, const std::string& other) {
  for (const Correlation& entry : robot.uncertainty_correlations)
    if ((entry.first == one && entry.second == other) || (entry.first == other && entry.second == one))
      return entry.correlation;
  return 0.0;
}

Eigen::MatrixXd nuisance_correlation(const Robot& robot) {
  const std::vector<Nuisance> nuisances = nuisances_of(robot);
  const Eigen::Index size = std::ssize(nuisances);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
  const auto key = [&](Eigen::Index k) { return nuisances[static_cast<std::size_t>(k)].key; };
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index k = 0; k < i; ++k)
      if (key(i) != key(k)) matrix(i, k) = matrix(k, i) = stated_correlation(robot, key(i), key(k));
  for (Eigen::Index i = 1; i < size; ++i)
    if (key(i) == key(i - 1)) make_conditionally_independent(i - 1, i, matrix);
  return matrix;
}

bool may_correlate(const Robot& robot, const std::string& key) {
  const std::vector<Nuisance> nuisances = nuisances_of(robot);
  return std::any_of(nuisances.begin(), nuisances.end(), [&](const Nuisance& nuisance) {
    return nuisance.key == key && !is_payload_nuisance(nuisance);
  });
}

std::optional<Eigen::MatrixXd> cholesky_factor(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return Eigen::MatrixXd{};
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  Eigen::MatrixXd lower = factor.matrixL();
  if (factor.info() != Eigen::Success || !lower.allFinite() ||
      lower.diagonal().array().square().minCoeff() < kLeastPivot)
    return std::nullopt;
  return lower;
}

double correlated_variance(const std::vector<double>& shifts, const Eigen::MatrixXd& correlation) {
  double half = 0.0;
  for (std::size_t i = 0; i < shifts.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      half += correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) * shifts[i] * shifts[k];
  return 2 * half;
}

Eigen::MatrixXd correlation_of(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd weight = covariance.diagonal().unaryExpr(
      [](double variance) { return variance > 0 ? 1 / std::sqrt(variance) : 0.0; });
  Eigen::MatrixXd correlation = weight.asDiagonal() * covariance * weight.asDiagonal();
  correlation.diagonal().setOnes();
  return correlation;
}

void state_sigma(const std::string& key, double sigma, Robot& robot) {
  robot.uncertainty[key] = sigma;
  std::erase_if(robot.uncertainty_correlations,
                [&](const Correlation& pair) { return pair.first == key || pair.second == key; });
}

void state_correlations(const std::vector<std::string>& keys, const Eigen::MatrixXd& correlation,
                        Robot& robot) {
  const auto is_one = [&](const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::erase_if(robot.uncertainty_correlations,
                [&](const Correlation& pair) { return is_one(pair.first) && is_one(pair.second); });
  for (int percent = 100; percent > 0; --percent) {
    Robot stated = robot;
    for (Correlation& pair : rounded_pairs(keys, 0.01 * percent * correlation, robot))
      stated.uncertainty_correlations.push_back(std::move(pair));
    if (!cholesky_factor(nuisance_correlation(stated))) continue;
    robot = std::move(stated);
    return;
  }
}

}  // namespace joulepath
