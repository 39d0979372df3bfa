#include "diagnosis/energies_only/energy_equations.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/evidence/signatures.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

constexpr double kSmoothPriorSd = 0.2;  ///< of the smooth function's coefficients

Eigen::VectorXd row_scatter_J(const EnergyRun& run, const EnergyNoise& noise) {
  const double joules = std::abs(run.measured_J());
  if (!run.wheel_J) return Eigen::VectorXd::Constant(1, joules * noise.sum);
  return Eigen::Vector2d(joules * noise.sum, joules * noise.difference);
}

/// What a smooth error may depend on; payload and acceleration scaled to about one.
Eigen::VectorXd features_of(const EnergyRun& run) {
  const double load = run.payload_kg / 10.0, haste = run.acceleration_m_s2 / 0.2 - 1;
  const double left = run.path == "curve to the left", right = run.path == "curve to the right",
               other = run.path == "spin" || run.path == "standstill";
  Eigen::VectorXd features(9);
  features << 1, load, haste, load * haste, left, right, other, (left + right) * load, (left + right) * haste;
  return features;
}

/// Ridge regression of a relative error on the runs' circumstances.
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

/// (model - measured) / measured of one row of the runs that have it.
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

/// Rows of all columns of one run over its scatter, the residual last.
Eigen::MatrixXd run_matrix(const EnergyRun& run, const Robot& robot, const std::vector<Nuisance>& nuisances,
                           const ModelState& state, const std::vector<Candidate>& candidates,
                           const std::vector<Column>& columns, const EnergyNoise& noise) {
  const auto at = [&](const DrivenMotion& motion, const ModelState& s) {
    return energy_rows(run, joules_of(motion, model_point(robot, nuisances, s)));
  };
  const Eigen::VectorXd base = at(run.motion, state);
  Eigen::MatrixXd matrix(base.size(), static_cast<Eigen::Index>(columns.size()) + 1);
  matrix.col(matrix.cols() - 1) = measured_rows(run) - base;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = columns[k];
    const auto owner = static_cast<std::size_t>(column.owner);
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(base.size());
    if (column.kind == Column::Kind::nuisance && owner >= nuisances.size()) {
      const auto& both = run.doubted[owner - nuisances.size()];
      slope = 0.5 * (at(both[1], state) - at(both[0], state));
    } else if (column.kind == Column::Kind::nuisance) {
      ModelState less = state, more = state;
      less.nuisance_fraction[owner] -= nuisances[owner].sigma;
      more.nuisance_fraction[owner] += nuisances[owner].sigma;
      slope = (at(run.motion, more) - at(run.motion, less)) / (2 * nuisances[owner].sigma);
    } else {
      const auto part = static_cast<std::size_t>(column.part);
      const AmplitudeStep step = amplitude_step(state, candidates[owner], part);
      const auto changed = [&](double change) {
        return at(run.motion, with_change(state, candidates[owner], step, part, change));
      };
      slope = (changed(step.high) - changed(step.low)) / (step.high - step.low);
    }
    matrix.col(static_cast<Eigen::Index>(k)) = slope;
    matrix.col(matrix.cols() - 1) += column.current * slope;  // parameters are absolute
  }
  return row_scatter_J(run, noise).cwiseInverse().asDiagonal() * matrix;
}

}  // namespace

Eigen::VectorXd energy_rows(const EnergyRun& run, const RunJoules& joules) {
  if (!run.wheel_J) return Eigen::VectorXd::Constant(1, joules.battery_J);
  return Eigen::Vector2d(joules.wheel_J.left + joules.wheel_J.right,
                         joules.wheel_J.right - joules.wheel_J.left);
}

Eigen::VectorXd measured_rows(const EnergyRun& run) {
  return energy_rows(
      run, {.wheel_J = run.wheel_J.value_or(Sided<double>{}), .battery_J = run.battery_J.value_or(0.0)});
}

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

Equations build_energy_equations(const std::vector<EnergyRun>& runs, const Robot& robot,
                                 const std::vector<Nuisance>& nuisances, const ModelState& state,
                                 const Eigen::VectorXd& doubts, const std::vector<Candidate>& candidates,
                                 const EnergyNoise& noise) {
  Equations equations{.candidates = candidates};
  equations.columns = list_columns(robot, nuisances, state, candidates, 0, false);
  std::erase_if(equations.columns, [](const Column& c) { return c.kind == Column::Kind::shape; });
  for (std::size_t k = 0; k < kMotionDoubts.size(); ++k)
    equations.columns.insert(equations.columns.begin() + static_cast<std::ptrdiff_t>(nuisances.size() + k),
                             {Column::Kind::nuisance, static_cast<int>(nuisances.size() + k), 0, 1.0,
                              doubts[static_cast<Eigen::Index>(k)]});
  equations.prior_sd.resize(static_cast<Eigen::Index>(equations.columns.size()));
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    equations.prior_sd[static_cast<Eigen::Index>(k)] = equations.columns[k].prior_sd;
  equations.runs.resize(runs.size());
  parallel_for(runs.size(), [&](std::size_t r) {
    const Eigen::MatrixXd matrix =
        run_matrix(runs[r], robot, nuisances, state, candidates, equations.columns, noise);
    equations.runs[r].gram = matrix.transpose() * matrix;
  });
  return equations;
}

}  // namespace joulepath
