#pragma once

#include <vector>

#include "diagnosis/evidence/equations.hpp"

namespace joulepath {

/// The problem of some runs with the calibration's columns projected out; the other columns keep their
/// places.
[[nodiscard]] LinearProblem without_calibration(const Equations& equations,
                                                const std::vector<std::size_t>& runs,
                                                double dispersion = 1.0);

/// Columns of the fit of everything: its scatter from run to run measures what the noise model lacks.
[[nodiscard]] std::vector<int> rich_columns(const Equations& equations);

/// How much more runs scatter about the fit of some columns than the noise model says (>= 1): squares of
/// run-wise scores over their expectation, over all columns but the dictionary's. Of a run with Gram matrix
/// G the scores about the fit have the covariance G - G S G, S being the fit's covariance: what the fit
/// absorbs of few runs' noise is not expected to be left.
[[nodiscard]] double run_dispersion(const Equations& equations, const std::vector<int>& fitted);

/// All parameters of a problem, those of the given columns fitted and the others zero.
[[nodiscard]] Eigen::VectorXd fit_parameters(const LinearProblem& problem, const std::vector<int>& columns,
                                             double dispersion, Eigen::MatrixXd* covariance = nullptr);

/// All parameters (nuisances too) fitted with the given candidates on the given runs.
[[nodiscard]] Eigen::VectorXd fit_parameters(const Equations& equations, const std::vector<std::size_t>& runs,
                                             const std::vector<int>& columns, double dispersion,
                                             Eigen::MatrixXd* covariance = nullptr);

}  // namespace joulepath
