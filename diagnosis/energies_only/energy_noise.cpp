#include "diagnosis/energies_only/energy_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Variables of a smooth error; payload and acceleration are scaled to about one.
Eigen::VectorXd features_of(const EnergyRun& run) {
  const double load = run.payload_kg / kPayloadOfSmoothError_kg,
               haste = run.acceleration_m_s2 / kUsualAcceleration_m_s2 - 1;
  const double left = run.path == "curve to the left", right = run.path == "curve to the right",
               other = run.path == "spin" || run.path == "standstill";
  Eigen::VectorXd features(9);
  features << 1, load, haste, load * haste, left, right, other, (left + right) * load, (left + right) * haste;
  return features;
}

/// Ridge regression of a relative error on the variables of the runs.
struct SmoothFit {
  Eigen::VectorXd coefficient{};
  double left_square{};  ///< mean square of the residual, corrected for degrees of freedom
  double freedom{};
};

SmoothFit fit_smoothly(const std::vector<EnergyRun>& runs, const std::vector<std::size_t>& which,
                       const Eigen::VectorXd& error, double scatter) {
  const Eigen::Index p = features_of(runs.front()).size();
  Eigen::MatrixXd x(static_cast<Eigen::Index>(which.size()), p);
  for (std::size_t k = 0; k < which.size(); ++k)
    x.row(static_cast<Eigen::Index>(k)) = features_of(runs[which[k]]);
  const Eigen::MatrixXd gram = x.transpose() * x;
  const Eigen::LLT<Eigen::MatrixXd> factor(gram + std::pow(scatter / kSmoothPriorSd, 2) *
                                                      Eigen::MatrixXd::Identity(p, p));
  SmoothFit fit{.coefficient = factor.solve(x.transpose() * error)};
  fit.freedom = static_cast<double>(which.size()) - factor.solve(gram).trace();
  fit.left_square = (error - x * fit.coefficient).squaredNorm() / std::max(1.0, fit.freedom);
  return fit;
}

/// (model - measured) / measured of one row of each run that has it.
Eigen::VectorXd relative_errors(const std::vector<EnergyRun>& runs, const std::vector<std::size_t>& which,
                                const Robot& robot, Eigen::Index row) {
  Eigen::VectorXd error(static_cast<Eigen::Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k) {
    const EnergyRun& run = runs[which[k]];
    const Eigen::VectorXd gap =
        energy_rows(run, joules_of(run.motion, {.robot = robot})) - measured_rows(run);
    error[static_cast<Eigen::Index>(k)] = gap[row] / std::abs(run.measured_J());
  }
  return error;
}

double scatter_of(const std::vector<EnergyRun>& runs, const std::vector<std::size_t>& which,
                  const Robot& robot, Eigen::Index row) {
  if (which.empty()) return kUsualScatter;
  const SmoothFit fit = fit_smoothly(runs, which, relative_errors(runs, which, robot, row), kUsualScatter);
  if (fit.freedom < kLeastFreedom) return kUsualScatter;
  return std::max(kLeastScatter, std::sqrt(fit.left_square));
}

}  // namespace

EnergyNoise estimate_energy_noise(const std::vector<EnergyRun>& runs, const Robot& robot) {
  std::vector<std::size_t> of_wheels;
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (runs[r].wheel_J) of_wheels.push_back(r);
  return {.sum = scatter_of(runs, every(runs.size()), robot, 0),
          .difference = scatter_of(runs, of_wheels, robot, 1)};
}

double noise_floor_percent(const EnergyNoise& noise) {
  return 100 * noise.sum * std::sqrt(2 / std::numbers::pi);
}

Eigen::VectorXd smooth_error(const std::vector<EnergyRun>& runs, const std::vector<std::size_t>& fitted,
                             const std::vector<std::size_t>& judged, const Robot& robot) {
  const SmoothFit fit = fit_smoothly(runs, fitted, relative_errors(runs, fitted, robot, 0), kUsualScatter);
  Eigen::VectorXd error(static_cast<Eigen::Index>(judged.size()));
  for (std::size_t k = 0; k < judged.size(); ++k)
    error[static_cast<Eigen::Index>(k)] = features_of(runs[judged[k]]).dot(fit.coefficient);
  return error;
}

}  // namespace joulepath
