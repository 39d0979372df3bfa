#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/signals/acceleration_noise.hpp"
#include "diagnosis/signals/friction_direction.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/dataset.hpp"
#include "model/kinematics.hpp"
#include "model/motion.hpp"
#include "model/power.hpp"

namespace joulepath {

/// What the motors draw from the supply and return to it (negative) as the supply counts it, of the samples
/// of a log: the power of a mean is not the mean of a power that changes its sign, nor of two factors that
/// change. Empty where the log does not show both motors.
struct SupplyAccount {
  Eigen::VectorXd draw_W{}, return_W{};
  /// What draw and return have in common within the kernel: of a power that changes its sign, or that is
  /// below its noise, nobody knows which it is.
  Eigen::VectorXd mixed_W{};
  Sided<Eigen::VectorXd> motor_W{};  ///< of each motor, positive and negative parts together

  [[nodiscard]] bool empty() const { return draw_W.size() == 0; }
  /// Of both motors at a sample.
  [[nodiscard]] double supply_W(const PowerSupply& supply, Eigen::Index j) const {
    return draw_W[j] + supply.regeneration_efficiency * return_W[j];
  }
  /// Of each motor at a sample.
  [[nodiscard]] Sided<double> mean_W(Eigen::Index j) const { return {motor_W.left[j], motor_W.right[j]}; }
};

/// Between the readings of instruments other than the motors' driver. A log repeats or interpolates the
/// readings of a slow one.
struct ReadingPeriods {
  double battery_s{}, gyro_s{}, pose_s{};
};

/// One run, smoothed and downsampled for the diagnosis.
///
/// Every measured channel is convolved with the same Gaussian kernel before downsampling; a wheel's
/// acceleration is its speed convolved with the kernel's derivative. A convolution commutes with every linear
/// term of the equations of motion, so currents and accelerations match although neither is differentiated.
/// Accelerations that do not stand out of their noise are zero.
/// Absent channels are empty.
struct RunSignals {
  std::string name{};
  std::size_t run_index{};
  double period_s{};        ///< period of these samples, not of the log
  double log_period_s{};    ///< of the log
  double kernel_sigma_s{};  ///< of the smoothing
  ReadingPeriods reading_period_s{};
  Eigen::VectorXd time_s{};
  Eigen::VectorXd time_of_day_s{};
  Eigen::VectorXd payload_kg{};
  bool payload_known{true};  ///< false: payload_kg is a guess, or an estimate from this log
  Sided<Eigen::VectorXd> wheel_speed_rad_s{};
  Sided<Eigen::VectorXd> wheel_acceleration_rad_s2{};
  NoisyModes acceleration_noise{};             ///< of them, before samples are left out
  Sided<Eigen::VectorXd> wheel_jerk_rad_s3{};  ///< zero below its noise; empty: unknown
  /// Mean over the kernel of the direction of the log's samples, -1 to 1; empty: of the mean speed.
  Sided<Eigen::VectorXd> wheel_direction{};
  Sided<Eigen::VectorXd> wheel_angle_rad{};  ///< since the run's start
  /// Integrals of a wheel's speed times cosine and sine of the measured heading: the wheel's contribution to
  /// x and y per meter of radius (times two, because the axle's midpoint moves with the mean of both wheels).
  Sided<Eigen::VectorXd> wheel_along_x_rad{};
  Sided<Eigen::VectorXd> wheel_along_y_rad{};
  Sided<Eigen::VectorXd> motor_voltage_V{};
  Sided<Eigen::VectorXd> motor_current_A{};
  /// Mean over the kernel of the sign of the log's samples of a current, -1 to 1; empty without currents.
  Sided<Eigen::VectorXd> current_direction{};
  Sided<Eigen::VectorXd> motor_power_W{};  ///< logged; or V i of each sample; or (R i + Kv n q') i
  /// What the mean of voltage times current has beyond the product of their means, as logged: free of noise
  /// in the mean, since both noises are independent. Empty where no power of the samples is known.
  Sided<Eigen::VectorXd> motor_covariance_W{};
  SupplyAccount motors_at_supply{};
  /// What the battery's power has beyond mean_supply_power_W() at the mean motion, as the file's robot lets
  /// expect it of the log's samples. Empty where the motors are logged, or where no sample is finer.
  Eigen::VectorXd expected_beyond_mean_W{};
  Eigen::VectorXd battery_power_W{};
  Eigen::VectorXd battery_voltage_V{};
  Eigen::VectorXd battery_current_A{};
  /// Samples that show a new reading of a slow battery monitor. Empty: all.
  std::vector<bool> battery_read{};
  Eigen::VectorXd gyro_yaw_rate_rad_s{};
  Eigen::VectorXd x_m{};
  Eigen::VectorXd y_m{};
  Eigen::VectorXd heading_rad{};  ///< unwrapped; integrated from wheels and gyro where the log has no heading
  bool heading_measured{};
  bool time_of_day_known{};
  /// Samples in which the wheels' difference stands out of its noise: the body turns. Empty: all.
  std::vector<bool> yawing{};
  /// Samples in which a wheel turns in one direction within the whole kernel, so that dry friction has a
  /// known sign.
  Sided<std::vector<bool>> turning{};
  /// Samples in which a measured current is beyond the driver's dead band; inside it the voltage is
  /// arbitrary. Empty without currents.
  Sided<std::vector<bool>> conducting{};
  DeviationOf<Eigen::VectorXd> deviation{};  ///< of a simulator from the model, which predictions have added

  Eigen::Index size() const { return time_s.size(); }

  /// Direction with which dry friction acts on a wheel at a sample, -1 to 1.
  [[nodiscard]] double direction(Side side, Eigen::Index j) const {
    const Eigen::VectorXd& mean = wheel_direction[side];
    return mean.size() > 0 ? mean[j] : friction_direction(wheel_speed_rad_s[side][j]);
  }

  /// Sign of a motor's current at a sample, -1 to 1, by which a driver's voltage drop acts: as logged, else
  /// of the current that is expected.
  [[nodiscard]] double current_sign(Side side, Eigen::Index j, double expected_A) const {
    const Eigen::VectorXd& mean = current_direction[side];
    return mean.size() > 0 ? mean[j] : soft_sign(expected_A, kBlurredCurrent_A);
  }

  /// Motion of the body at a sample as the wheels tell it, without creep.
  [[nodiscard]] BodyMotion<double> rolled_motion(const Geometry& geometry, Eigen::Index j) const {
    const auto at = [j](const Sided<Eigen::VectorXd>& v) { return Sided<double>{v.left[j], v.right[j]}; };
    const Twist<double> twist = body_twist(geometry, at(wheel_speed_rad_s)),
                        rate = body_twist(geometry, at(wheel_acceleration_rad_s2));
    return {twist.speed_m_s, rate.speed_m_s, twist.yaw_rate_rad_s, rate.yaw_rate_rad_s};
  }
};

/// Marks the samples whose currents are beyond the driver's dead band.
void mark_conducting(RunSignals& run, const Robot& robot);

/// True if the motor power is measured or known from the currents.
[[nodiscard]] bool measures_motors(const RunSignals& run);
/// True if an energy is measured: at the motors or at the battery's terminals.
[[nodiscard]] bool measures_energy(const RunSignals& run);

struct SignalOptions {
  double kernel_sigma_s{kKernelSigma_s};
  double period_s{kPeriod_s};
  double least_turning_speed_rad_s{kLeastTurningSpeed_rad_s};
  double channel_delay_s{};  ///< delay at which the electrical channels are read
};

/// Smooths and downsamples a usable log; at least one row is left.
RunSignals make_run_signals(const Run& run, std::size_t run_index, const Robot& robot,
                            const SignalOptions& options = {});

/// Noise of a usable log's accelerations, and the width of the kernel under which it was seen.
struct SmoothedNoise {
  NoisyModes accelerations{};
  double kernel_sigma_s{};
};
[[nodiscard]] SmoothedNoise smoothed_noise(const Run& run, const Robot& robot, const SignalOptions& options);

/// True for a run that can be diagnosed sample by sample: wheel speeds, `kLeastSamples`, `kLeastLength_s`.
bool has_usable_log(const Run& run);

/// True for a run with a prescribed motion, an energy and no log.
[[nodiscard]] bool is_energy_run(const Run& run);

}  // namespace joulepath
