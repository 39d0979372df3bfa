#include "diagnosis/evidence/linear_fit.hpp"

#include <algorithm>
#include <numeric>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"

namespace joulepath {

LinearProblem without_calibration(const Equations& equations, const std::vector<std::size_t>& runs,
                                  double dispersion) {
  const LinearProblem all = sum_runs(equations.runs, runs, equations.prior_sd);
  const std::vector<int> nuisances = equations.columns_of(Column::Kind::nuisance);
  std::vector<int> kept(equations.columns.size());
  std::iota(kept.begin(), kept.end(), 0);
  return project_out(all, nuisances, kept, dispersion);
}

std::vector<int> rich_columns(const Equations& equations) {
  std::vector<int> columns;
  for (auto kind :
       {Column::Kind::amplitude, Column::Kind::dictionary, Column::Kind::shape, Column::Kind::form}) {
    const std::vector<int> of_kind = equations.columns_of(kind);
    columns.insert(columns.end(), of_kind.begin(), of_kind.end());
  }
  return columns;
}

double run_dispersion(const Equations& equations, const std::vector<int>& fitted) {
  Eigen::MatrixXd covariance;
  const Eigen::VectorXd parameters =
      fit_parameters(equations, every(equations.runs.size()), fitted, 1.0, &covariance);
  std::vector<int> columns = equations.columns_of(Column::Kind::nuisance), judged;
  columns.insert(columns.end(), fitted.begin(), fitted.end());
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    if (equations.columns[k].kind != Column::Kind::dictionary) judged.push_back(static_cast<int>(k));
  const Eigen::Index p = parameters.size();
  std::vector<Eigen::MatrixX3d> scores(equations.runs.size());  // square, expectation, the noise's own
  parallel_for(scores.size(), [&](std::size_t r) {
    const Eigen::MatrixXd& gram = equations.runs[r].gram;
    const Eigen::MatrixXd some = gram(judged, columns);
    scores[r].resize(std::ssize(judged), 3);
    const Eigen::VectorXd score = gram.col(p).head(p) - gram.topLeftCorner(p, p) * parameters;
    scores[r].col(0) = score(judged).cwiseAbs2();
    scores[r].col(2) = gram.diagonal()(judged);
    scores[r].col(1) = scores[r].col(2) - (some * covariance).cwiseProduct(some).rowwise().sum();
  });
  Eigen::MatrixX3d sum = Eigen::MatrixX3d::Zero(std::ssize(judged), 3);
  for (const Eigen::MatrixX3d& of_run : scores) sum += of_run;
  double found = 0, due = 0;
  for (const auto& column : sum.rowwise()) {
    if (column[2] <= 0) continue;
    found += column[0] / column[2];
    due += std::max(0.0, column[1]) / column[2];
  }
  return due > 0 ? std::max(1.0, found / due) : 1.0;
}

Eigen::VectorXd fit_parameters(const LinearProblem& problem, const std::vector<int>& columns,
                               double dispersion, Eigen::MatrixXd* covariance) {
  const Posterior posterior = solve(problem, columns, dispersion);
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(problem.prior_sd.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    parameters[columns[k]] = posterior.mean[static_cast<Eigen::Index>(k)];
  if (covariance) *covariance = posterior.covariance;
  return parameters;
}

Eigen::VectorXd fit_parameters(const Equations& equations, const std::vector<std::size_t>& runs,
                               const std::vector<int>& columns, double dispersion,
                               Eigen::MatrixXd* covariance) {
  std::vector<int> all = equations.columns_of(Column::Kind::nuisance);
  all.insert(all.end(), columns.begin(), columns.end());
  return fit_parameters(sum_runs(equations.runs, runs, equations.prior_sd), all, dispersion, covariance);
}

}  // namespace joulepath
