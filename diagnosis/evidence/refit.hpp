#pragma once

#include <vector>

#include "diagnosis/evidence/attribution.hpp"
#include "diagnosis/signals/log_set.hpp"

namespace joulepath {

/// Takes an explanation over into a state: amplitudes, shapes and calibration as the linear fit has them.
[[nodiscard]] ModelState adopt(const Equations& equations, const std::vector<Nuisance>& nuisances,
                               const ModelState& state, const Explanation& explanation,
                               const Eigen::VectorXd& parameters);

/// A state fitted by Gauss-Newton on full predictions, with its uncertainty.
struct Refit {
  ModelState state{};
  std::vector<RunSignals> signals{};  ///< read at the state's delay
  Equations equations{};              ///< about the state, its own effects alone
  Eigen::VectorXd parameters{};       ///< of the equations
  Eigen::MatrixXd covariance{};       ///< of nuisances, then the effects' columns, by the noise model
  Eigen::MatrixXd run_covariance{};   ///< the same from how runs differ
  std::size_t fit_runs{};
  std::vector<int> columns{};  ///< rows of `covariance`
  double dispersion{1.0};
};

/// Refines a state on some of the log set's runs (indices into LogSet::runs), noise model given, until a step
/// hardly moves it. The unknown terms of the given labels are fitted along with it.
[[nodiscard]] Refit refit(const LogSet& logs, const std::vector<std::size_t>& fit_runs,
                          const std::vector<Nuisance>& nuisances, ModelState state, const NoiseModel& noise,
                          const Eigen::VectorXd& run_variance, double dispersion,
                          const std::set<std::string>& unknowns = {});

/// The state that some runs alone give: one step from the fitted one on their equations.
[[nodiscard]] ModelState state_of_runs(const Refit& fitted, const std::vector<Nuisance>& nuisances,
                                       const std::vector<std::size_t>& runs);

}  // namespace joulepath
