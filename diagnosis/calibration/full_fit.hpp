#pragma once

#include "diagnosis/calibration/wheel_equations.hpp"

namespace joulepath::calibration {

using FreeParameters = std::array<bool, kFitParameters>;

/// Weights of the current and the voltage equation: inverse variances of their residuals.
struct FitWeights {
  double torque{1};
  double voltage{};
};

struct FitResult {
  FitValues values{};
  bool converged{};
  FreeParameters at_bound{};  ///< parameters at their lower bound
};

/// Mean squared residuals of currents (A^2) and voltages (V^2, 0 without voltages).
[[nodiscard]] double current_mean_square_A2(const FitSums& sums, const FitValues& values);
[[nodiscard]] double voltage_mean_square_V2(const FitSums& sums, const FitValues& values);

/// Inverse residual variances of the unbounded linear fits.
[[nodiscard]] FitWeights fit_weights(const FitSums& sums, const FitValues& start, const FreeParameters& free);

/// Minimizes the weighted squared residuals over the free parameters between `lower` and infinity (NLopt
/// LD_SLSQP, exact gradients). Voltage residuals are projected on the instruments (wheel_equations.hpp). The
/// search starts from the separate fits of the two equations. Parameters that are not free keep the values of
/// `start`.
[[nodiscard]] FitResult fit_full(const FitSums& sums, const FitWeights& weights, const FitValues& start,
                                 const FitValues& lower, const FreeParameters& free);

/// Gauss-Newton information of the parameters at `values`, for independent residuals with the variances of
/// the weights.
[[nodiscard]] Eigen::Matrix<double, kFitParameters, kFitParameters> information(const FitSums& sums,
                                                                                const FitWeights& weights,
                                                                                const FitValues& values);

}  // namespace joulepath::calibration
