#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "diagnosis/calibration/smoothed_run.hpp"

namespace joulepath::calibration {

/// What the full method fits, in this order.
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

/// Sums of products of one run (or of a block of one), all that least squares needs of it. With
///   Kt n i = T_m sign(q') + nu q' + J q''_mean + D (q'' - q''_mean) + p x_payload + x_known,
/// torque = sum of (x, i)(x, i)^T over both wheels' samples, and voltage the same of
/// (sign left, sign right, q', q''_mean, q'' - q''_mean | di/dt, i, q', V): instruments, then the voltage
/// equation's own columns. The share of white noise in smoothed speeds is taken out.
struct FitSums {
  static constexpr int kVoltageColumns = 9;
  static constexpr int kTorqueColumns = 8;  ///< six factors, the known torque, the current
  Eigen::Matrix<double, kTorqueColumns, kTorqueColumns> torque =
      Eigen::Matrix<double, kTorqueColumns, kTorqueColumns>::Zero();
  Eigen::Matrix<double, kVoltageColumns, kVoltageColumns> voltage =
      Eigen::Matrix<double, kVoltageColumns, kVoltageColumns>::Zero();
  double acceleration_noise{};  ///< what was taken out of (q''_mean)^2, and as much of the other
  double torque_count{};
  double voltage_count{};
  double independent_share{};  ///< samples that are independent after smoothing / samples
  std::size_t samples{};

  FitSums& operator+=(const FitSums& other);
  FitSums& operator-=(const FitSums& other);
};

/// The parameters as the robot file has them, payload factor 1. R, Kt n are the mean of both sides.
[[nodiscard]] FitValues nominal_values(const Robot& robot);

/// Sums for each run; where there are fewer than `fewest_runs`, for blocks of `block_s` of each run.
[[nodiscard]] std::vector<FitSums> fit_sums(const Robot& robot, const std::vector<SmoothedRun>& runs,
                                            std::size_t fewest_runs, double block_s);

/// A side's R, Kt n and nu relative to the mean of both sides: kept as in the robot file.
struct SideRatios {
  double resistance{1}, torque_per_ampere{1}, viscous{1};
  double voltage_over_torque_constant{1};
};
[[nodiscard]] SideRatios side_ratios(const Robot& robot, Side side);

}  // namespace joulepath::calibration
