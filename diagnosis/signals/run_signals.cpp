#include "diagnosis/signals/run_signals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/signals/velocity_filter.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/constant_payload.hpp"
#include "model/assert.hpp"
#include "model/kinematics.hpp"
#include "model/limit_table.hpp"
#include "model/local_fit.hpp"
#include "model/median.hpp"
#include "model/motor.hpp"

namespace joulepath {
namespace {

using Samples = std::vector<double>;

/// The log on a uniform grid: unchanged where its period is steady, else interpolated. Rounded stamps have
/// the steady period in their mean.
struct UniformLog {
  Samples time_s{};
  double period_s{};
  bool resampled{};
};

UniformLog uniform_grid(const Samples& time_s) {
  Samples steps(time_s.size() - 1);
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) steps[i] = time_s[i + 1] - time_s[i];
  UniformLog grid{.time_s = time_s, .period_s = upper_median(std::move(steps)), .resampled = false};
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i)
    grid.resampled |= std::abs(time_s[i + 1] - time_s[i] - grid.period_s) > kUnevenPeriod * grid.period_s;
  const double length_s = time_s.back() - time_s.front();
  if (!grid.resampled) {
    grid.period_s = length_s / static_cast<double>(time_s.size() - 1);
    return grid;
  }
  grid.period_s = std::max(grid.period_s, length_s / (kMostGrowth * static_cast<double>(time_s.size())));
  grid.time_s.clear();
  for (double t = time_s.front(); t <= time_s.back() + 1e-9; t += grid.period_s) grid.time_s.push_back(t);
  return grid;
}

/// As wide as the filter of the speeds, unless the log is short: what remains behind a filter has its memory,
/// and rows of a narrower kernel repeat each other. A narrower kernel than usual is what was asked for.
double kernel_sigma_s(const Samples& time_s, const SignalOptions& options, double velocity_filter_s) {
  constexpr double kKernelsOfLog = 14;  // twice the kernel's length
  if (options.kernel_sigma_s < kKernelSigma_s) return options.kernel_sigma_s;
  return std::max(kKernelSigma_s, std::min(std::max(options.kernel_sigma_s, velocity_filter_s),
                                           (time_s.back() - time_s.front()) / kKernelsOfLog));
}

class Thinner {
 public:
  Thinner(const Trajectory& log, const SignalOptions& options, double velocity_filter_s)
      : log_(log), velocity_filter_s_(velocity_filter_s), grid_(uniform_grid(log.time_s)) {
    sigma_s_ = std::max(kernel_sigma_s(log.time_s, options, velocity_filter_s),
                        kLeastKernelPeriods * grid_.period_s);
    kernel_ = gaussian_kernel(sigma_s_, grid_.period_s);
    set_strides(options.period_s);
    const std::size_t margin = kernel_.half_width();
    for (std::size_t c = margin; c + margin < grid_.time_s.size(); c += fine_) fine_centers_.push_back(c);
    for (std::size_t k = 0; k < fine_centers_.size(); k += thinning_) centers_.push_back(fine_centers_[k]);
  }

  const Samples& grid_time_s() const { return grid_.time_s; }
  double sigma_s() const { return sigma_s_; }
  double grid_period_s() const { return grid_.period_s; }
  double period_s() const { return fine_period_s() * static_cast<double>(thinning_); }
  /// Of the samples by which noise is judged: a long dataset's own are too far apart.
  double fine_period_s() const { return grid_.period_s * static_cast<double>(fine_); }
  const std::vector<std::size_t>& centers() const { return centers_; }
  std::size_t half_width() const { return kernel_.half_width(); }

  /// The channel on the uniform grid, read `delay_s` later.
  Samples on_grid(const Samples& channel, double delay_s = 0) const {
    if (channel.empty()) return {};
    if (!grid_.resampled && delay_s == 0) return channel;
    Samples at_s = grid_.time_s;
    for (double& t : at_s) t += delay_s;
    return interpolate(log_.time_s, channel, at_s);
  }

  /// The same of another channel than the speeds, or of a product of such: behind the filter of the speeds.
  Samples reading(const Samples& channel, double delay_s = 0) const {
    return behind_filter(on_grid(channel, delay_s));
  }
  Samples behind_filter(Samples on_grid) const {
    return behind_velocity_filter(std::move(on_grid), grid_.time_s, velocity_filter_s_);
  }
  Samples before_filter(const Samples& on_grid) const {
    return before_velocity_filter(on_grid, grid_.time_s, velocity_filter_s_);
  }

  /// The channel with its last stated value: a payload changes in steps and is not interpolated.
  Eigen::VectorXd held(const Samples& channel) const {
    if (channel.empty()) return {};
    Eigen::VectorXd result(static_cast<Eigen::Index>(centers_.size()));
    for (std::size_t j = 0; j < centers_.size(); ++j) {
      const auto next = std::upper_bound(log_.time_s.begin(), log_.time_s.end(), grid_.time_s[centers_[j]]);
      const auto index = std::max<std::ptrdiff_t>(0, next - log_.time_s.begin() - 1);
      result[static_cast<Eigen::Index>(j)] = channel[static_cast<std::size_t>(index)];
    }
    return result;
  }

  const SmoothingKernel& kernel() const { return kernel_; }
  Eigen::VectorXd smooth(const Samples& on_grid) const { return at(centers_, on_grid, kernel_.weight); }
  /// Convolved with weights of the kernel, at the fine samples.
  Sided<Eigen::VectorXd> fine(const Sided<Samples>& on_grid, const Samples& weights) const {
    return {at(fine_centers_, on_grid.left, weights), at(fine_centers_, on_grid.right, weights)};
  }
  /// Of values at the fine samples, those that count.
  Eigen::VectorXd thinned(const Eigen::VectorXd& fine) const {
    return fine(Eigen::seqN(0, std::ssize(centers_), static_cast<Eigen::Index>(thinning_)));
  }
  std::vector<bool> thinned(const std::vector<bool>& fine) const {
    std::vector<bool> result(centers_.size());
    for (std::size_t j = 0; j < result.size(); ++j) result[j] = fine[j * thinning_];
    return result;
  }
  /// Variance of the third differences over that of the values, at the fine samples, both of white noise of a
  /// channel convolved with these weights.
  double third_difference_gain(const Samples& weights) const {
    return 20 - 30 * correlation(weights, 1) + 12 * correlation(weights, 2) - 2 * correlation(weights, 3);
  }
  /// The same of the mean of a window of 2 kAccelerationWindow_s.
  double mean_gain(const Samples& weights) const {
    const auto count = 2 * std::lround(kAccelerationWindow_s / fine_period_s()) + 1;
    double sum = static_cast<double>(count);
    for (long lag = 1; lag < count; ++lag)
      sum += 2 * static_cast<double>(count - lag) * correlation(weights, static_cast<std::size_t>(lag));
    return std::max(0.0, sum) / static_cast<double>(count * count);
  }

 private:
  /// Rows are about `period_s` apart: every so many fine samples, which are at most about kPeriod_s apart,
  /// under a wider kernel as much further.
  void set_strides(double period_s) {
    const auto steps = [&](double length_s) {
      return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(length_s / grid_.period_s)));
    };
    const std::size_t stride = steps(period_s),
                      most = steps(kPeriod_s * std::max(1.0, sigma_s_ / kKernelSigma_s));
    thinning_ = (stride + most - 1) / most;
    fine_ = (stride + thinning_ - 1) / thinning_;
  }

  /// Of white noise of a channel convolved with these weights, between fine samples.
  double correlation(const Samples& weights, std::size_t lag) const {
    const std::size_t shift = std::min(lag * fine_, weights.size());
    return std::inner_product(weights.begin() + static_cast<std::ptrdiff_t>(shift), weights.end(),
                              weights.begin(), 0.0) /
           std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  }

  static Eigen::VectorXd at(const std::vector<std::size_t>& centers, const Samples& on_grid,
                            const Samples& weights) {
    if (on_grid.empty()) return {};
    Eigen::VectorXd result(static_cast<Eigen::Index>(centers.size()));
    for (std::size_t j = 0; j < centers.size(); ++j)
      result[static_cast<Eigen::Index>(j)] = convolve_at(on_grid, weights, centers[j]);
    return result;
  }

  const Trajectory& log_;
  double velocity_filter_s_{};
  UniformLog grid_;
  double sigma_s_{};
  SmoothingKernel kernel_{};
  std::size_t fine_{1};      ///< grid steps between fine samples
  std::size_t thinning_{1};  ///< fine samples between rows
  std::vector<std::size_t> fine_centers_{}, centers_{};
};

/// Poses at the middle of each sample. Means over a sample's period belong to its middle, logged poses to its
/// end.
Samples at_sample_middle(Samples pose) {
  for (std::size_t i = pose.size(); i-- > 1;) pose[i] = 0.5 * (pose[i] + pose[i - 1]);
  return pose;
}

/// Integral up to the middle of each sample of rates that are means over the sample.
Samples integrate_to_middle(const Samples& rate, double period_s) {
  Samples result(rate.size());
  double sum = 0;
  for (std::size_t i = 0; i < rate.size(); ++i) {
    result[i] = sum + 0.5 * rate[i] * period_s;
    sum += rate[i] * period_s;
  }
  return result;
}

Sided<Samples> wheel_speeds(const Trajectory& log, const Robot& robot) {
  if (!log.wheel_speed_rad_s.left.empty()) return log.wheel_speed_rad_s;
  Sided<Samples> wheels;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const Sided<double> speed =
        wheel_speeds_rad_s(robot.geometry, log.linear_speed_m_s[i], log.angular_speed_rad_s[i]);
    wheels.left.push_back(speed.left);
    wheels.right.push_back(speed.right);
  }
  return wheels;
}

Samples heading_from_wheels(const Sided<Samples>& wheels, const Robot& robot, double period_s) {
  Samples rate(wheels.left.size());
  for (std::size_t i = 0; i < rate.size(); ++i)
    rate[i] = body_twist(robot.geometry, Sided<double>{wheels.left[i], wheels.right[i]}).yaw_rate_rad_s;
  return integrate_to_middle(rate, period_s);
}

Samples product(const Samples& a, const Samples& b) {
  if (a.empty() || b.empty()) return {};
  Samples result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

/// Voltage of a measured current where none is logged: R i + Kv n q' with the winding of the robot file.
Samples winding_V(const Motor& motor, const Samples& speed_rad_s, const Samples& current_A) {
  Samples voltage(current_A.size());
  for (std::size_t k = 0; k < voltage.size(); ++k)
    voltage[k] = motor_voltage_V(motor, current_A[k], speed_rad_s[k]);
  return voltage;
}

/// Takes the noise out of accelerations at the fine samples. What their third differences have is noise or
/// motion; noise is no more than white noise of the samples would leave.
NoisyModes remove_noise(const Thinner& thinner, const Sided<Samples>& wheels, Sided<Eigen::VectorXd>& rate) {
  const Samples& weights = thinner.kernel().slope_weight;
  NoisyModes noise = remove_acceleration_noise(rate, thinner.third_difference_gain(weights),
                                               thinner.fine_period_s(), thinner.mean_gain(weights));
  const double gain = std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
  const auto limit = [&](double other, NoisySquares& squares) {
    Samples mode = thinner.before_filter(wheels.left);
    const Samples right = thinner.before_filter(wheels.right);
    for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = 0.5 * (mode[i] + other * right[i]);
    const double white = gain * std::pow(noise_of_readings(mode), 2) * static_cast<double>(rate.left.size());
    squares.noise = std::min(squares.noise, white);
  };
  limit(1, noise.driving);
  limit(-1, noise.turning);
  return noise;
}

/// Accelerations and jerks without noise, and where the body turns.
void fill_rates(RunSignals& signals, const Thinner& thinner, const Sided<Samples>& wheels) {
  const SmoothingKernel& kernel = thinner.kernel();
  Sided<Eigen::VectorXd> rate = thinner.fine(wheels, kernel.slope_weight),
                         jerk = thinner.fine(wheels, kernel.curvature_weight);
  signals.acceleration_noise = remove_noise(thinner, wheels, rate);
  remove_jerk_noise(jerk, thinner.third_difference_gain(kernel.curvature_weight));
  for (Side side : kSides) {
    signals.wheel_acceleration_rad_s2[side] = thinner.thinned(rate[side]);
    signals.wheel_jerk_rad_s3[side] = thinner.thinned(jerk[side]);
  }
  const Sided<Eigen::VectorXd> speed = thinner.fine(wheels, kernel.weight);
  signals.yawing = thinner.thinned(beyond_noise(
      speed.right - speed.left, thinner.third_difference_gain(kernel.weight), thinner.fine_period_s()));
}

/// Mean of the direction of the samples: where a wheel starts, stops or reverses within the kernel, dry
/// friction acts while it turns, which the mean speed does not tell. Noise of the samples is no direction;
/// where it exceeds what the mean speed leaves in doubt, the mean speed decides. Behind a filter, a wheel's
/// speed still falls when the wheel is at rest: the direction is that of the speed before it.
Eigen::VectorXd mean_direction(const Thinner& thinner, const Samples& logged_rad_s) {
  const Samples speed_rad_s = thinner.before_filter(logged_rad_s);
  const double blurred_rad_s = std::max(kStillWheel_rad_s, kSampleOverNoise * noise_of_readings(speed_rad_s));
  if (blurred_rad_s > kBlurredWheel_rad_s) return {};
  Samples direction(speed_rad_s.size());
  std::ranges::transform(speed_rad_s, direction.begin(),
                         [&](double speed) { return friction_direction(speed, blurred_rad_s); });
  return thinner.smooth(thinner.behind_filter(std::move(direction)));
}

void fill_wheels(RunSignals& signals, const Thinner& thinner, const Sided<Samples>& wheels,
                 const Samples& heading, double least_speed_rad_s) {
  fill_rates(signals, thinner, wheels);
  for (Side side : kSides) {
    const Samples& speed = wheels[side];
    signals.wheel_speed_rad_s[side] = thinner.smooth(speed);
    signals.wheel_direction[side] = mean_direction(thinner, speed);
    signals.wheel_angle_rad[side] = thinner.smooth(integrate_to_middle(speed, thinner.grid_period_s()));
    Samples along_x(speed.size()), along_y(speed.size());
    for (std::size_t i = 0; i < speed.size(); ++i) {
      along_x[i] = speed[i] * std::cos(heading[i]);
      along_y[i] = speed[i] * std::sin(heading[i]);
    }
    signals.wheel_along_x_rad[side] = thinner.smooth(integrate_to_middle(along_x, thinner.grid_period_s()));
    signals.wheel_along_y_rad[side] = thinner.smooth(integrate_to_middle(along_y, thinner.grid_period_s()));
    const Eigen::VectorXd& smooth = signals.wheel_speed_rad_s[side];
    const double reach_s = static_cast<double>(thinner.half_width()) * thinner.grid_period_s();
    signals.turning[side].resize(static_cast<std::size_t>(smooth.size()));
    for (Eigen::Index j = 0; j < smooth.size(); ++j) {
      const double change = reach_s * std::abs(signals.wheel_acceleration_rad_s2[side][j]);
      signals.turning[side][static_cast<std::size_t>(j)] = std::abs(smooth[j]) - change > least_speed_rad_s;
    }
  }
}

/// Samples with which a channel has a new reading: a value that is neither that before it nor on the line
/// through the two before it, but for the rounding of a float. A reading between two samples bends the line
/// at both.
std::vector<std::size_t> new_readings(const Samples& channel) {
  if (channel.empty()) return {};
  const auto [least, most] = std::ranges::minmax(channel);
  const double rounding = 1e-7 * (most - least);
  const auto bends = [&](std::size_t i) {
    if (i < 2 || i >= channel.size() || channel[i] == channel[i - 1]) return false;
    const double step = channel[i] - channel[i - 1], before = channel[i - 1] - channel[i - 2];
    return std::abs(step - before) > rounding + 1e-6 * (std::abs(step) + std::abs(before));
  };
  std::vector<std::size_t> at;
  for (std::size_t i = 2; i < channel.size(); ++i)
    if (bends(i) && !(bends(i + 1) && !bends(i + 2) && !bends(i - 1))) at.push_back(i);
  return at;
}

/// Time between the readings of a channel: the mean of the steps that are within a sample of the median, by
/// turns where it is no whole number of samples.
double reading_period_s(const Samples& channel, double log_period_s) {
  const std::vector<std::size_t> at = new_readings(channel);
  std::vector<std::size_t> steps;
  for (std::size_t k = 1; k < at.size(); ++k) steps.push_back(at[k] - at[k - 1]);
  if (steps.empty()) return log_period_s;
  const std::size_t median = upper_median(steps);
  double count = 0, sum = 0;
  for (const std::size_t step : steps)
    if (step + 1 >= median && step <= median + 1) count += 1, sum += static_cast<double>(step);
  return sum / count * log_period_s;
}

/// Below this current the dead band of a driver hides the winding: less than the friction current.
double dead_band_A(const Motor& motor) {
  return std::min(kDeadBand_A, 0.5 * motor.friction_torque_Nm / motor.torque_per_ampere_Nm_A());
}

std::vector<bool> beyond(const Eigen::VectorXd& values, double least) {
  std::vector<bool> result(static_cast<std::size_t>(values.size()));
  for (Eigen::Index j = 0; j < values.size(); ++j)
    result[static_cast<std::size_t>(j)] = std::abs(values[j]) >= least;
  return result;
}

void fill_circumstances(RunSignals& signals, const Thinner& thinner, const Run& run) {
  signals.time_s = thinner.smooth(thinner.grid_time_s());
  signals.time_of_day_known = run.start_time_s.has_value();
  signals.time_of_day_s = signals.time_s.array() + run.start_time_s.value_or(0.0);
  signals.payload_kg = thinner.held(run.log.payload_kg);
  if (signals.payload_kg.size() == 0)
    signals.payload_kg = Eigen::VectorXd::Constant(signals.size(), constant_payload_kg(run));
}

/// The account of both motors' powers (W) in the log's samples.
SupplyAccount account_of(const Sided<Samples>& power, PowerSharing sharing, const Thinner& thinner,
                         double delay_s) {
  if (power.left.empty() || power.right.empty()) return {};
  std::vector<Samples> counted{power.left, power.right};
  if (sharing == PowerSharing::bus) {
    std::ranges::transform(power.left, power.right, counted[0].begin(), std::plus<>{});
    counted.pop_back();
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(thinner.centers().size()));
  SupplyAccount account{.draw_W = zero, .return_W = zero, .mixed_W = zero};
  for (Side side : kSides) account.motor_W[side] = thinner.smooth(thinner.reading(power[side], delay_s));
  for (Samples& drawn_W : counted) {
    Samples returned_W = drawn_W;
    for (double& power_W : drawn_W) power_W = std::max(0.0, power_W);
    for (double& power_W : returned_W) power_W = std::min(0.0, power_W);
    const Eigen::VectorXd draw_W = thinner.smooth(thinner.reading(drawn_W, delay_s)),
                          return_W = thinner.smooth(thinner.reading(returned_W, delay_s));
    account.draw_W += draw_W;
    account.return_W += return_W;
    account.mixed_W += draw_W.cwiseMin(-return_W);
  }
  return account;
}

/// Mean of the signs of a current's samples: within the kernel a current may change its direction or rest,
/// which its mean does not tell. Samples within their noise have the sign of their own mean.
Eigen::VectorXd mean_sign(const Thinner& thinner, const Samples& current_A, double delay_s) {
  const double noise_A = kSampleOverNoise * noise_of_readings(current_A);
  Samples sign(current_A.size()), doubt(current_A.size()), doubtful_A(current_A.size());
  for (std::size_t i = 0; i < sign.size(); ++i) {
    doubt[i] = std::abs(current_A[i]) > noise_A ? 0.0 : 1.0;
    sign[i] = std::copysign(1 - doubt[i], current_A[i]);
    doubtful_A[i] = doubt[i] * current_A[i];
  }
  const auto mean = [&](const Samples& samples) { return thinner.smooth(thinner.reading(samples, delay_s)); };
  Eigen::VectorXd result = mean(sign);
  const Eigen::VectorXd share = mean(doubt), sum_A = mean(doubtful_A);
  for (Eigen::Index j = 0; j < result.size(); ++j)
    if (share[j] > 0) result[j] += share[j] * soft_sign(sum_A[j] / share[j], kBlurredCurrent_A);
  return result;
}

/// Voltage, current and power of both motors; the power by the winding where no voltage is logged.
void fill_motors(RunSignals& signals, const Thinner& thinner, const Trajectory& log, const Robot& robot,
                 const Sided<Samples>& logged_wheels, double delay_s) {
  const auto mean = [&](const Samples& samples) { return thinner.smooth(thinner.reading(samples, delay_s)); };
  Sided<Samples> counted;  // V i where it is logged: what the driver row compares
  for (Side side : kSides) {
    const Samples& current_A = log.motor_current_A[side];
    signals.motor_voltage_V[side] = mean(log.motor_voltage_V[side]);
    signals.motor_current_A[side] = mean(current_A);
    signals.current_direction[side] = mean_sign(thinner, current_A, delay_s);
    const Samples voltage_V = log.motor_voltage_V[side].empty()
                                  ? winding_V(robot.motor[side], logged_wheels[side], current_A)
                                  : log.motor_voltage_V[side];
    const Samples product_W = product(voltage_V, current_A);
    if (!product_W.empty())
      signals.motor_covariance_W[side] = mean(product_W) - mean(voltage_V).cwiseProduct(mean(current_A));
    const Samples& power = log.motor_power_W[side].empty() ? product_W : log.motor_power_W[side];
    signals.motor_power_W[side] = mean(power);
    counted[side] = log.motor_voltage_V[side].empty() || current_A.empty() ? power : product_W;
  }
  signals.motors_at_supply = account_of(counted, robot.power.sharing, thinner, delay_s);
  mark_conducting(signals, robot);
}

/// Of a channel with slow readings, one row for each: the first whose kernel holds nothing before it.
std::vector<bool> rows_of_readings(const Thinner& thinner, const Samples& channel) {
  std::vector<bool> rows(thinner.centers().size(), false);
  for (const std::size_t at : new_readings(thinner.on_grid(channel))) {
    const auto row = std::ranges::lower_bound(thinner.centers(), at + thinner.half_width());
    if (row != thinner.centers().end())
      rows[static_cast<std::size_t>(row - thinner.centers().begin())] = true;
  }
  return rows;
}

void fill_battery(RunSignals& signals, const Thinner& thinner, const Trajectory& log) {
  if (signals.reading_period_s.battery_s > kBlurredReadings * signals.kernel_sigma_s)
    signals.battery_read = rows_of_readings(thinner, log.battery_current_A);
  signals.battery_voltage_V = thinner.smooth(thinner.reading(log.battery_voltage_V));
  signals.battery_current_A = thinner.smooth(thinner.reading(log.battery_current_A));
  signals.battery_power_W =
      thinner.smooth(thinner.reading(product(log.battery_voltage_V, log.battery_current_A)));
}

void fill_pose(RunSignals& signals, const Thinner& thinner, const Trajectory& log, const Samples& heading) {
  signals.gyro_yaw_rate_rad_s = thinner.smooth(thinner.reading(log.gyro_yaw_rate_rad_s));
  signals.heading_rad = thinner.smooth(heading);
  if (log.position_x_m.empty() || log.position_y_m.empty()) return;
  signals.x_m = thinner.smooth(at_sample_middle(thinner.reading(log.position_x_m)));
  signals.y_m = thinner.smooth(at_sample_middle(thinner.reading(log.position_y_m)));
}

/// A simulator's deviation at the run's samples. Where its wheels do not turn, dry friction has no known
/// sign.
void fill_deviation(RunSignals& signals, const SimulatorDeviation& deviation) {
  const Samples at_s(signals.time_s.begin(), signals.time_s.end());
  signals.deviation = deviation.of.changed<Eigen::VectorXd>([&](const Samples& series) {
    if (series.empty()) return Eigen::VectorXd();
    const Samples values = interpolate(deviation.time_s, series, at_s);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values)));
  });
  for (Side side : kSides)
    for (Eigen::Index j = 0; j < signals.size(); ++j)
      if (signals.deviation.turning[side][j] < 1) signals.turning[side][static_cast<std::size_t>(j)] = false;
}

}  // namespace

void mark_conducting(RunSignals& run, const Robot& robot) {
  for (Side side : kSides)
    run.conducting[side] = beyond(run.motor_current_A[side], dead_band_A(robot.motor[side]));
}

bool measures_motors(const RunSignals& run) {
  return run.size() > 0 &&
         (run.motor_power_W.left.size() == run.size() || run.motor_power_W.right.size() == run.size());
}

bool measures_energy(const RunSignals& run) {
  return measures_motors(run) || (run.size() > 0 && run.battery_power_W.size() == run.size());
}

bool has_usable_log(const Run& run) {
  const bool wheels = !run.log.wheel_speed_rad_s.left.empty() && !run.log.wheel_speed_rad_s.right.empty();
  const bool body = !run.log.linear_speed_m_s.empty() && !run.log.angular_speed_rad_s.empty();
  return run.log.size() >= kLeastSamples &&
         run.log.time_s.back() - run.log.time_s.front() >= kLeastLength_s && (wheels || body);
}

bool is_energy_run(const Run& run) { return run.motion && (run.measured_energy_J || run.battery_energy_Wh); }

SmoothedNoise smoothed_noise(const Run& run, const Robot& robot, const SignalOptions& options) {
  const Thinner thinner(run.log, options, run.velocity_filter_s);
  const Sided<Samples> logged = wheel_speeds(run.log, robot);
  const Sided<Samples> wheels{thinner.on_grid(logged.left), thinner.on_grid(logged.right)};
  Sided<Eigen::VectorXd> rate = thinner.fine(wheels, thinner.kernel().slope_weight);
  return {.accelerations = remove_noise(thinner, wheels, rate), .kernel_sigma_s = thinner.sigma_s()};
}

RunSignals make_run_signals(const Run& run, std::size_t run_index, const Robot& robot,
                            const SignalOptions& options) {
  JOULEPATH_ASSERT(has_usable_log(run), "a run without wheel speeds cannot be smoothed");
  const Trajectory& log = run.log;
  const Thinner thinner(log, options, run.velocity_filter_s);
  RunSignals signals{.name = run.name,
                     .run_index = run_index,
                     .period_s = thinner.period_s(),
                     .log_period_s = thinner.grid_period_s(),
                     .kernel_sigma_s = thinner.sigma_s()};
  signals.reading_period_s = {
      .battery_s = reading_period_s(log.battery_current_A, signals.log_period_s),
      .gyro_s = reading_period_s(log.gyro_yaw_rate_rad_s, signals.log_period_s),
      .pose_s = reading_period_s(log.position_x_m.empty() ? log.heading_rad : log.position_x_m,
                                 signals.log_period_s)};

  const Sided<Samples> logged_wheels = wheel_speeds(log, robot);
  const Sided<Samples> wheels{thinner.on_grid(logged_wheels.left), thinner.on_grid(logged_wheels.right)};
  signals.heading_measured = !log.heading_rad.empty();
  const Samples heading = signals.heading_measured
                              ? at_sample_middle(thinner.reading(unwrap_angle(log.heading_rad)))
                              : heading_from_wheels(wheels, robot, thinner.grid_period_s());
  fill_wheels(signals, thinner, wheels, heading, options.least_turning_speed_rad_s);

  fill_circumstances(signals, thinner, run);
  signals.payload_known = run.payload_known || payload_limit_kg(robot) <= 0;
  fill_motors(signals, thinner, log, robot, logged_wheels, options.channel_delay_s);
  fill_battery(signals, thinner, log);
  fill_pose(signals, thinner, log, heading);
  if (run.deviation) fill_deviation(signals, *run.deviation);
  return signals;
}

}  // namespace joulepath
