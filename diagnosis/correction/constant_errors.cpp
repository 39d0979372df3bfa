#include "diagnosis/correction/constant_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "model/nuisance_correlation.hpp"

namespace joulepath {
namespace {

/// A key of the robot file, its greater sigma, and its rows among the errors.
struct KeyedError {
  double sigma{};
  Sided<Eigen::Index> row{};
};

/// Both sides of a key that has one error are the same row.
std::map<std::string, KeyedError> errors_by_key(const ConstantErrors& errors,
                                                const std::vector<Nuisance>& nuisances,
                                                const ModelState& state) {
  std::map<std::string, KeyedError> by_key;
  for (Eigen::Index row = 0; row < errors.deviation.size(); ++row) {
    const std::size_t k = errors.nuisances[static_cast<std::size_t>(row)];
    KeyedError& error = by_key[nuisances[k].key];
    error.sigma = std::max(error.sigma, errors.deviation[row] / (1 + state.nuisance_fraction[k]));
    for (const Side side : kSides)
      if (nuisances[k].side.value_or(side) == side) error.row[side] = row;
  }
  return by_key;
}

}  // namespace

ConstantErrors constant_errors(const Refit& fitted, const std::vector<Nuisance>& nuisances,
                               const Robot& file) {
  ConstantErrors errors;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < fitted.columns.size(); ++i) {
    const Column& column = fitted.equations.columns[static_cast<std::size_t>(fitted.columns[i])];
    const auto owner = static_cast<std::size_t>(column.owner);
    if (column.kind != Column::Kind::nuisance || !may_correlate(file, nuisances[owner].key)) continue;
    errors.nuisances.push_back(owner);
    rows.push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::MatrixXd by_noise = fitted.covariance(rows, rows), by_runs = fitted.run_covariance(rows, rows);
  errors.correlation = correlation_of(by_noise);
  errors.deviation.resize(std::ssize(rows));
  for (Eigen::Index k = 0; k < errors.deviation.size(); ++k)
    errors.deviation[k] = std::min(std::sqrt(std::max(by_noise(k, k), by_runs(k, k))),
                                   nuisances[errors.nuisances[static_cast<std::size_t>(k)]].sigma);
  return errors;
}

void write_constant_errors(const ConstantErrors& errors, const std::vector<Nuisance>& nuisances,
                           const ModelState& state, Robot& robot) {
  if (errors.nuisances.empty()) return;
  std::vector<std::string> keys;
  Sided<std::vector<Eigen::Index>> rows;
  for (const auto& [key, error] : errors_by_key(errors, nuisances, state)) {
    if (!(error.sigma > 0)) continue;  // not measured
    state_sigma(key, error.sigma, robot);
    keys.push_back(key);
    for (const Side side : kSides) rows[side].push_back(error.row[side]);
  }
  const Eigen::MatrixXd& all = errors.correlation;
  state_correlations(keys, 0.5 * (all(rows.left, rows.left) + all(rows.right, rows.right)), robot);
}

}  // namespace joulepath
