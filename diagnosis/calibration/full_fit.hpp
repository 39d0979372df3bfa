#pragma once

#include "diagnosis/calibration/wheel_equations.hpp"

namespace joulepath::calibration {

using FreeParameters = std::array<bool, kFitParameters>;

/// Weights of the two equations: the inverse variances of their residuals.
struct FitWeights {
  double torque{1};
  double voltage{};
};

struct FitResult {
  FitValues values{};
  bool converged{};
  FreeParameters at_bound{};  ///< stopped by its lower bound
};

/// Mean squared residuals of currents (A^2) and voltages (V^2); the latter 0 without voltages.
[[nodiscard]] double current_mean_square_A2(const FitSums& sums, const FitValues& values);
[[nodiscard]] double voltage_mean_square_V2(const FitSums& sums, const FitValues& values);

/// Inverse residual variances of the free linear fits.
[[nodiscard]] FitWeights fit_weights(const FitSums& sums, const FitValues& start, const FreeParameters& free);

/// Minimizes the weighted squares (of voltages: their projection on the instruments, wheel_equations.hpp)
/// over the free parameters within `lower` and infinity (NLopt LD_SLSQP, exact gradients), starting where the
/// two equations alone lead; parameters that are not free keep `start`'s values.
[[nodiscard]] FitResult fit_full(const FitSums& sums, const FitWeights& weights, const FitValues& start,
                                 const FitValues& lower, const FreeParameters& free);

/// Gauss-Newton information of the parameters at `values`, for independent residuals of the weights'
/// variances.
[[nodiscard]] Eigen::Matrix<double, kFitParameters, kFitParameters> information(const FitSums& sums,
                                                                                const FitWeights& weights,
                                                                                const FitValues& values);

}  // namespace joulepath::calibration
