#include "diagnosis/numerics/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "model/assert.hpp"
// Design: docs/decisions/0502-noise-and-scatter.md
namespace joulepath {
namespace {

Eigen::MatrixXd pick(const Eigen::MatrixXd& matrix, const std::vector<int>& rows,
                     const std::vector<int>& cols) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(cols.size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < cols.size(); ++j)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix(rows[i], cols[j]);
  return out;
}

Eigen::VectorXd pick(const Eigen::VectorXd& vector, const std::vector<int>& rows) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) out[static_cast<Eigen::Index>(i)] = vector[rows[i]];
  return out;
}

double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

/// (Z'Z + D^-1)^-1 written with D^(1/2) outside, so that a variance of zero is allowed.
Eigen::MatrixXd own_covariance(const Eigen::MatrixXd& zz, const Eigen::VectorXd& variance) {
  const Eigen::VectorXd sd = variance.cwiseMax(0).cwiseSqrt();
  const Eigen::Index k = sd.size();
  const Eigen::MatrixXd scaled = sd.asDiagonal() * zz * sd.asDiagonal();
  const Eigen::MatrixXd inner = Eigen::LLT<Eigen::MatrixXd>(Eigen::MatrixXd::Identity(k, k) + scaled)
                                    .solve(Eigen::MatrixXd::Identity(k, k));
  return sd.asDiagonal() * inner * sd.asDiagonal();
}

}  // namespace

Eigen::VectorXd run_variances(const std::vector<RawRunEquations>& runs, const ColumnEstimate& estimate,
                              const Eigen::VectorXd& start_variance, Eigen::Index given) {
  std::vector<Eigen::MatrixXd> absorbed;  // Z'X S X'Z of each run
  for (const RawRunEquations& run : runs) {
    const auto cross = run.gram.block(run.columns, 0, run.own_columns, run.columns);
    absorbed.push_back(cross * (estimate.covariance * cross.transpose()));
  }
  Eigen::VectorXd variance = start_variance;
  for (int iteration = 0; iteration < 30; ++iteration) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(variance.size());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const Eigen::MatrixXd& gram = runs[r].gram;
      const Eigen::Index p = runs[r].columns, k = runs[r].own_columns;
      const Eigen::MatrixXd covariance = own_covariance(gram.block(p, p, k, k), variance);
      const Eigen::VectorXd mean =
          covariance * (gram.block(p, p + k, k, 1) - gram.block(p, 0, k, p) * estimate.mean);
      sum += mean.cwiseAbs2() + covariance.diagonal() + (covariance * absorbed[r] * covariance).diagonal();
    }
    variance = sum / std::max<double>(1.0, static_cast<double>(runs.size()));
    variance.tail(given) = start_variance.tail(given);
  }
  return variance;
}

RunEquations marginalize(const RawRunEquations& run, const Eigen::VectorXd& variance) {
  const Eigen::Index p = run.columns, k = run.own_columns;
  Eigen::MatrixXd kept(p + 1, p + 1), cross(k, p + 1);
  kept.topLeftCorner(p, p) = run.gram.topLeftCorner(p, p);
  kept.topRightCorner(p, 1) = run.gram.block(0, p + k, p, 1);
  kept.bottomLeftCorner(1, p) = run.gram.block(p + k, 0, 1, p);
  kept(p, p) = run.gram(p + k, p + k);
  cross.leftCols(p) = run.gram.block(p, 0, k, p);
  cross.rightCols(1) = run.gram.block(p, p + k, k, 1);
  const Eigen::MatrixXd covariance = own_covariance(run.gram.block(p, p, k, k), variance);
  kept -= cross.transpose() * covariance * cross;
  return {.gram = kept, .own = covariance * cross};
}

LinearProblem sum_runs(const std::vector<RunEquations>& runs, const std::vector<std::size_t>& which,
                       const Eigen::VectorXd& prior_sd) {
  const Eigen::Index p = prior_sd.size();
  LinearProblem problem{
      .gram = Eigen::MatrixXd::Zero(p, p), .right = Eigen::VectorXd::Zero(p), .prior_sd = prior_sd};
  for (std::size_t r : which) {
    problem.gram += runs[r].gram.topLeftCorner(p, p);
    problem.right += runs[r].gram.topRightCorner(p, 1);
    problem.residual_square += runs[r].gram(p, p);
  }
  return problem;
}

Posterior solve(const LinearProblem& problem, const std::vector<int>& columns, double dispersion,
                bool with_covariance) {
  Posterior posterior{.columns = columns};
  const auto k = static_cast<Eigen::Index>(columns.size());
  posterior.loss = problem.residual_square / dispersion;
  posterior.log_evidence = -0.5 * posterior.loss;
  if (k == 0) return posterior;
  const Eigen::VectorXd sd = pick(problem.prior_sd, columns);
  const Eigen::VectorXd right = sd.cwiseProduct(pick(problem.right, columns)) / dispersion;
  const Eigen::MatrixXd precision =
      Eigen::MatrixXd::Identity(k, k) +
      Eigen::MatrixXd(sd.asDiagonal() * pick(problem.gram, columns, columns) * sd.asDiagonal()) / dispersion;
  const Eigen::LLT<Eigen::MatrixXd> factor(precision);
  const Eigen::VectorXd scaled = factor.solve(right);
  posterior.mean = sd.cwiseProduct(scaled);
  if (with_covariance)
    posterior.covariance = sd.asDiagonal() * factor.solve(Eigen::MatrixXd::Identity(k, k)) * sd.asDiagonal();
  posterior.loss -= right.dot(scaled);
  posterior.log_evidence = -0.5 * posterior.loss - 0.5 * log_determinant(factor);
  return posterior;
}

LinearProblem project_out(const LinearProblem& problem, const std::vector<int>& nuisances,
                          const std::vector<int>& kept, double dispersion) {
  LinearProblem out{.gram = pick(problem.gram, kept, kept),
                    .right = pick(problem.right, kept),
                    .residual_square = problem.residual_square,
                    .prior_sd = pick(problem.prior_sd, kept)};
  const auto k = static_cast<Eigen::Index>(nuisances.size());
  if (k == 0) return out;
  const Eigen::VectorXd sd = pick(problem.prior_sd, nuisances);
  const Eigen::MatrixXd cross = sd.asDiagonal() * pick(problem.gram, nuisances, kept);
  const Eigen::VectorXd right = sd.cwiseProduct(pick(problem.right, nuisances));
  const Eigen::MatrixXd inner =
      dispersion * Eigen::MatrixXd::Identity(k, k) +
      Eigen::MatrixXd(sd.asDiagonal() * pick(problem.gram, nuisances, nuisances) * sd.asDiagonal());
  const Eigen::LLT<Eigen::MatrixXd> factor(inner);
  out.gram -= cross.transpose() * factor.solve(cross);
  out.right -= cross.transpose() * factor.solve(right);
  out.residual_square -= right.dot(factor.solve(right));
  return out;
}

Eigen::VectorXd own_deviations(const RunEquations& run, const Eigen::VectorXd& parameters) {
  return run.own.rightCols(1) - run.own.leftCols(parameters.size()) * parameters;
}

double run_loss(const RunEquations& run, const Eigen::VectorXd& parameters) {
  const Eigen::Index p = parameters.size();
  return run.gram(p, p) - 2 * parameters.dot(run.gram.topRightCorner(p, 1).col(0)) +
         parameters.dot(run.gram.topLeftCorner(p, p) * parameters);
}

}  // namespace joulepath
