#pragma once

#include <Eigen/Core>
#include <vector>

namespace joulepath {

/// One run compressed: phi'W phi, phi'W r and r'W r in one matrix, the residual being the last column.
/// The run is the unit of everything that follows: tests fold, flip or resample whole runs.
struct RunEquations {
  Eigen::MatrixXd gram{};
  Eigen::MatrixXd own{};  ///< the run's own deviations: last column - other columns x parameters
};

/// A run before its own deviations are taken out: columns, then the run's own columns, then residual.
struct RawRunEquations {
  Eigen::MatrixXd gram{};
  Eigen::Index columns{};
  Eigen::Index own_columns{};
};

/// A normal posterior of all columns' parameters, in the columns' order.
struct ColumnEstimate {
  Eigen::VectorXd mean{};
  Eigen::MatrixXd covariance{};
};

/// Variances of what differs from run to run (friction, resistance, offsets), one per own column, by
/// expectation maximization about the estimate of a rich fit:
///   D = mean over runs of E[z^2],  E[z^2] = mean^2 + C + C Z'X S X'Z C,  C = (Z'Z + D^-1)^-1
/// with S the estimate's covariance: what the fit absorbs of few runs' deviations counts as theirs
/// (restricted maximum likelihood; [LairdWare1982]). The last `given` variances stay as
/// they start.
[[nodiscard]] Eigen::VectorXd run_variances(const std::vector<RawRunEquations>& runs,
                                            const ColumnEstimate& estimate,
                                            const Eigen::VectorXd& start_variance, Eigen::Index given = 0);

/// Integrates the run's own columns out: deviations are normal with the given variances.
///   G - G_z' (Z'Z + D^-1)^-1 G_z
[[nodiscard]] RunEquations marginalize(const RawRunEquations& run, const Eigen::VectorXd& variance);

/// A Gaussian linear model over all runs: residual = columns x parameter + unit noise, with a normal
/// prior of zero mean on each parameter.
struct LinearProblem {
  Eigen::MatrixXd gram{};      ///< columns x columns
  Eigen::VectorXd right{};     ///< columns
  double residual_square{};    ///< r'r
  Eigen::VectorXd prior_sd{};  ///< columns
};

[[nodiscard]] LinearProblem sum_runs(const std::vector<RunEquations>& runs,
                                     const std::vector<std::size_t>& which, const Eigen::VectorXd& prior_sd);

struct Posterior {
  std::vector<int> columns{};
  Eigen::VectorXd mean{};
  Eigen::MatrixXd covariance{};
  double loss{};          ///< r'r + prior penalty at the mean: smaller is better
  double log_evidence{};  ///< up to a constant of the problem
};

/// Fits the given columns. `dispersion` multiplies the noise variance.
[[nodiscard]] Posterior solve(const LinearProblem& problem, const std::vector<int>& columns,
                              double dispersion = 1.0, bool with_covariance = true);

/// The problem with some columns fitted away: what is left is the same problem in fewer columns
/// (`kept`), and `log_evidence` differs by a constant only.
[[nodiscard]] LinearProblem project_out(const LinearProblem& problem, const std::vector<int>& nuisances,
                                        const std::vector<int>& kept, double dispersion = 1.0);

/// Deviations of the run's own parameters under given parameters (of all columns).
[[nodiscard]] Eigen::VectorXd own_deviations(const RunEquations& run, const Eigen::VectorXd& parameters);

/// r'r of a run under given parameters (of all columns).
[[nodiscard]] double run_loss(const RunEquations& run, const Eigen::VectorXd& parameters);

}  // namespace joulepath
