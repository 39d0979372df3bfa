#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "diagnosis/calibration/smoothed_run.hpp"

// Method: [SoederstroemStoica1983], [Fuller1987]
namespace joulepath::calibration {

/// Parameters of the full method, in the order of FitValues.
enum FitParameter : int {
  kFrictionLeft,  ///< T_m, N m
  kFrictionRight,
  kViscous,          ///< nu, N m s/rad
  kStraightInertia,  ///< J = m r^2/2 + I_w + I_s without payload, kg m^2 at the wheel
  kTurningInertia,   ///< D = I r^2/(2 l^2) + I_w + I_s without payload
  kPayloadFactor,    ///< payload on board / payload stated
  kTorquePerAmpere,  ///< Kt n, N m/A
  kResistance,       ///< R, ohm
  kFitParameters
};
using FitValues = std::array<double, kFitParameters>;

/// Sums of products over one run (or over a block of one); least squares needs nothing else. With
///   Kt n i = T_m sign(q') + nu q' + J q''_mean + D (q'' - q''_mean) + p x_payload + x_known,
/// torque = sum of (x, i)(x, i)^T over both wheels' samples. Likewise voltage = sum over (sign left, sign
/// right, q', q''_mean, q'' - q''_mean | di/dt, i, q', V): the instruments, then the columns of the voltage
/// equation. The share of white noise in the smoothed speeds is subtracted.
struct FitSums {
  static constexpr int kVoltageColumns = 9;
  static constexpr int kTorqueColumns = 8;  ///< six factors, the known torque, the current
  Eigen::Matrix<double, kTorqueColumns, kTorqueColumns> torque =
      Eigen::Matrix<double, kTorqueColumns, kTorqueColumns>::Zero();
  Eigen::Matrix<double, kVoltageColumns, kVoltageColumns> voltage =
      Eigen::Matrix<double, kVoltageColumns, kVoltageColumns>::Zero();
  double acceleration_noise{};  ///< noise subtracted from (q''_mean)^2, and the same amount from the other
                                ///< square
  double torque_count{};
  double voltage_count{};
  double independent_share{};  ///< ratio of independent samples after smoothing to all samples
  std::size_t samples{};

  FitSums& operator+=(const FitSums& other);
  FitSums& operator-=(const FitSums& other);
};

/// Parameter values of the robot file, with payload factor 1. R and Kt n are means of both sides.
[[nodiscard]] FitValues nominal_values(const Robot& robot);

/// Sums of each run; with fewer than `fewest_runs` runs, sums of blocks of `block_s`.
[[nodiscard]] std::vector<FitSums> fit_sums(const Robot& robot, const std::vector<SmoothedRun>& runs,
                                            std::size_t fewest_runs, double block_s);

/// R, Kt n and nu of each side relative to the mean of both sides, as in the robot file.
struct SideRatios {
  double resistance{1}, torque_per_ampere{1}, viscous{1};
  double voltage_over_torque_constant{1};
};
[[nodiscard]] SideRatios side_ratios(const Robot& robot, Side side);

}  // namespace joulepath::calibration
