#include "diagnosis/calibration/full_fit.hpp"

#include <nlopt.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "model/assert.hpp"

// Method: [Kraft1994]
namespace joulepath::calibration {
namespace {

using Columns = Eigen::Matrix<double, FitSums::kTorqueColumns, 1>;
constexpr int kFactors = 6;  ///< unknown factors of the torque equation: kFrictionLeft .. kPayloadFactor

/// Residual of the current equation as coefficients of its columns: e = (T, nu, J, D, p, 1) x / K - i.
Columns current_residual(const FitValues& values) {
  Columns c;
  for (int j = 0; j < kFactors; ++j) c[j] = values[static_cast<std::size_t>(j)] / values[kTorquePerAmpere];
  c[6] = 1 / values[kTorquePerAmpere];
  c[7] = -1;
  return c;
}

/// Derivative of current_residual() by a parameter.
Columns current_residual_slope(const FitValues& values, int parameter) {
  Columns c = Columns::Zero();
  const double K = values[kTorquePerAmpere];
  if (parameter < kFactors) c[parameter] = 1 / K;
  if (parameter == kTorquePerAmpere) {
    c = -current_residual(values) / K;
    c[7] = 0;
  }
  return c;
}

/// Coefficients of the voltage equation's residual e = R i + K q' - V on (i, q', V).
Eigen::Vector3d voltage_residual(const FitValues& values) {
  return {values[kResistance], values[kTorquePerAmpere], -1.0};
}

Eigen::Vector3d voltage_residual_slope(int parameter) {
  return {parameter == kResistance ? 1.0 : 0.0, parameter == kTorquePerAmpere ? 1.0 : 0.0, 0.0};
}

/// Voltage sums of Y = (i, q', V) projected on the instruments Z: Y^T Z (Z^T Z)^-1 Z^T Y, without the part
/// that di/dt explains. The instruments are signs, speeds, accelerations and di/dt. Stationary noise of the
/// measured current does not correlate with them, so it does not bias R. The model neglects the inductance;
/// without the di/dt column, the inductance would bias R where braking and accelerating currents differ.
Eigen::Matrix3d instrumented(const FitSums& sums) {
  const Eigen::Matrix<double, 6, 6> ZZ = sums.voltage.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 1> scale =
      ZZ.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, 6, 6> scaled = scale.asDiagonal() * ZZ * scale.asDiagonal();
  const Eigen::Matrix<double, 6, 4> ZY = scale.asDiagonal() * sums.voltage.block<6, 4>(0, 5);
  const Eigen::Matrix4d M = ZY.transpose() * scaled.completeOrthogonalDecomposition().solve(ZY);
  Eigen::Matrix3d rest = M.bottomRightCorner<3, 3>();
  if (!(M(0, 0) > 0)) return rest;
  return rest - M.bottomLeftCorner<3, 1>() * M.topRightCorner<1, 3>() / M(0, 0);
}

struct Problem {
  const FitSums& sums;
  Eigen::Matrix3d voltage{};
  const FitWeights& weights;
  const FitValues& start;
  std::vector<int> free{};
  std::vector<double> scale{};

  FitValues values(const double* x) const {
    FitValues all = start;
    for (std::size_t i = 0; i < free.size(); ++i) all[static_cast<std::size_t>(free[i])] = x[i] * scale[i];
    return all;
  }
};

double objective(unsigned count, const double* x, double* gradient, void* data) {
  const auto& problem = *static_cast<const Problem*>(data);
  const FitValues values = problem.values(x);
  const Columns c = current_residual(values);
  const Columns Gc = problem.sums.torque * c;
  const Eigen::Vector3d e = voltage_residual(values);
  const Eigen::Vector3d Ge = problem.voltage * e;
  const double share = 1 / std::max(1.0, problem.sums.torque_count + problem.sums.voltage_count);
  for (unsigned i = 0; gradient && i < count; ++i) {
    const int p = problem.free[i];
    gradient[i] = 2 * share * problem.scale[i] *
                  (problem.weights.torque * current_residual_slope(values, p).dot(Gc) +
                   problem.weights.voltage * voltage_residual_slope(p).dot(Ge));
  }
  return share * (problem.weights.torque * c.dot(Gc) + problem.weights.voltage * e.dot(Ge));
}

/// Least squares of `target` on the free columns of a matrix of sums; the other columns keep their given
/// factors.
Eigen::VectorXd solve_free(const Eigen::MatrixXd& sums, const std::vector<int>& columns,
                           const Eigen::VectorXd& rest) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd b(n);
  const Eigen::VectorXd moved = sums * rest;
  for (Eigen::Index i = 0; i < n; ++i) {
    b[i] = -moved[columns[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j)
      A(i, j) = sums(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd scale = A.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
  return scale.asDiagonal() * scaled.colPivHouseholderQr().solve(scale.asDiagonal() * b);
}

/// Start of the nonlinear fit: the voltage equation alone, then the current equation alone.
FitValues linear_fit(const FitSums& sums, const FitValues& start, const FreeParameters& free) {
  FitValues values = start;
  std::vector<int> columns;
  Eigen::VectorXd rest = voltage_residual(start);
  for (auto [parameter, column] : {std::pair{kResistance, 0}, std::pair{kTorquePerAmpere, 1}})
    if (free[parameter] && sums.voltage_count > 0) columns.push_back(column), rest[column] = 0;
  if (!columns.empty()) {
    const Eigen::VectorXd found = solve_free(instrumented(sums), columns, rest);
    for (std::size_t i = 0; i < columns.size(); ++i)
      values[columns[i] == 0 ? kResistance : kTorquePerAmpere] = found[static_cast<Eigen::Index>(i)];
  }
  if (!(values[kTorquePerAmpere] > 0)) values[kTorquePerAmpere] = start[kTorquePerAmpere];
  columns.clear();
  rest = current_residual(values);
  for (int j = 0; j < kFactors; ++j)
    if (free[static_cast<std::size_t>(j)]) columns.push_back(j), rest[j] = 0;
  if (columns.empty()) return values;
  const Eigen::VectorXd found = solve_free(sums.torque, columns, rest);
  for (std::size_t i = 0; i < columns.size(); ++i)
    values[static_cast<std::size_t>(columns[i])] =
        found[static_cast<Eigen::Index>(i)] * values[kTorquePerAmpere];
  return values;
}

}  // namespace

double current_mean_square_A2(const FitSums& sums, const FitValues& values) {
  const Columns c = current_residual(values);
  return sums.torque_count > 0 ? std::max(0.0, c.dot(sums.torque * c)) / sums.torque_count : 0.0;
}

double voltage_mean_square_V2(const FitSums& sums, const FitValues& values) {
  const Eigen::Vector3d e = voltage_residual(values);
  return sums.voltage_count > 0
             ? std::max(0.0, e.dot(sums.voltage.bottomRightCorner<3, 3>() * e)) / sums.voltage_count
             : 0.0;
}

FitWeights fit_weights(const FitSums& sums, const FitValues& start, const FreeParameters& free) {
  const FitValues values = linear_fit(sums, start, free);
  // For data without noise the residual is zero; a floor of 1e-7 of the signal keeps the weights finite.
  const double current_floor = 1e-14 * sums.torque(7, 7) / std::max(1.0, sums.torque_count);
  const double voltage_floor = 1e-14 * sums.voltage(8, 8) / std::max(1.0, sums.voltage_count);
  FitWeights weights{1 / std::max(current_mean_square_A2(sums, values), current_floor), 0.0};
  if (sums.voltage_count > 0)
    weights.voltage = 1 / std::max(voltage_mean_square_V2(sums, values), voltage_floor);
  return weights;
}

FitResult fit_full(const FitSums& sums, const FitWeights& weights, const FitValues& start,
                   const FitValues& lower, const FreeParameters& free) {
  FitResult result{.values = linear_fit(sums, start, free)};
  Problem problem{sums, instrumented(sums), weights, start};
  std::vector<double> x, bound;
  for (int p = 0; p < kFitParameters; ++p) {
    const auto at = static_cast<std::size_t>(p);
    if (!free[at]) continue;
    const double scale = start[at] > 0 ? start[at] : 1.0;
    problem.free.push_back(p), problem.scale.push_back(scale);
    bound.push_back(lower[at] / scale), x.push_back(std::max(result.values[at] / scale, bound.back()));
  }
  if (x.empty()) return result;
  const auto count = static_cast<unsigned>(x.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> solver(nlopt_create(NLOPT_LD_SLSQP, count),
                                                                      nlopt_destroy);
  JOULEPATH_ASSERT(solver, "NLopt has SLSQP");
  nlopt_set_min_objective(solver.get(), objective, &problem);
  nlopt_set_lower_bounds(solver.get(), bound.data());
  nlopt_set_xtol_rel(solver.get(), 1e-13);
  nlopt_set_ftol_rel(solver.get(), 1e-15);
  nlopt_set_maxeval(solver.get(), 500);
  double least = 0;
  const double before = objective(count, x.data(), nullptr, &problem);
  std::vector<double> best = x;
  const nlopt_result status = nlopt_optimize(solver.get(), best.data(), &least);
  // The sums are differences of large numbers: a gain below their rounding does not count, and the fit keeps
  // the start.
  const double rounding = 1e-14 *
                          (weights.torque * sums.torque(7, 7) + weights.voltage * sums.voltage(8, 8)) /
                          std::max(1.0, sums.torque_count + sums.voltage_count);
  if (std::isfinite(least) && least < before - rounding) x = best;
  result.converged = status > 0 || status == NLOPT_ROUNDOFF_LIMITED;
  result.values = problem.values(x.data());
  for (std::size_t i = 0; i < x.size(); ++i)
    result.at_bound[static_cast<std::size_t>(problem.free[i])] = x[i] <= bound[i] + 1e-9;
  return result;
}

Eigen::Matrix<double, kFitParameters, kFitParameters> information(const FitSums& sums,
                                                                  const FitWeights& weights,
                                                                  const FitValues& values) {
  const Eigen::Matrix3d voltage = instrumented(sums);
  Eigen::Matrix<double, kFitParameters, kFitParameters> H;
  for (int a = 0; a < kFitParameters; ++a)
    for (int b = 0; b < kFitParameters; ++b)
      H(a, b) = weights.torque *
                    current_residual_slope(values, a).dot(sums.torque * current_residual_slope(values, b)) +
                weights.voltage * voltage_residual_slope(a).dot(voltage * voltage_residual_slope(b));
  return sums.independent_share * H;
}

}  // namespace joulepath::calibration
