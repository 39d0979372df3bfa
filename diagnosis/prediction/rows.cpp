#include "diagnosis/prediction/rows.hpp"

#include <cmath>
#include <numbers>

#include "diagnosis/numerics/rms.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/mean_power.hpp"

namespace joulepath {
namespace {

void fill(Channel channel, const Eigen::VectorXd& residual, ResidualRows& rows) {
  rows.value.col(channel) = residual;
  rows.present.col(channel).setConstant(true);
}

void fill_motor(const RunSignals& signals, const Prediction& prediction, Side side, ResidualRows& rows) {
  const Eigen::Index n = signals.size();
  const int s = side == Side::left ? 0 : 1;
  const auto current = static_cast<Channel>(kCurrentLeft + s),
             winding = static_cast<Channel>(kWindingLeft + s);
  const bool has_current = signals.motor_current_A[side].size() == n && n > 0;
  const bool has_voltage = signals.motor_voltage_V[side].size() == n && n > 0;
  if (has_current) fill(current, signals.motor_current_A[side] - prediction.current_A[side], rows);
  if (has_voltage) {
    Eigen::VectorXd winding_V = signals.motor_voltage_V[side] - prediction.voltage_V[side];
    if (has_current)
      winding_V -= prediction.reading_resistance_ohm[side].cwiseProduct(rows.value.col(current));
    fill(winding, winding_V, rows);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const bool turning = signals.turning[side][static_cast<std::size_t>(j)];
    if (!turning) rows.present(j, current) = false;
    const bool told = has_current ? signals.conducting[side][static_cast<std::size_t>(j)] : turning;
    if (!told) rows.present(j, winding) = false;
  }
}

/// Whether each wheel turns in one direction within the whole kernel, or stands: slow, with neither an
/// acceleration nor a mean of one above its noise. Where one reverses, starts or stops, dry friction takes a
/// power that the smoothed motion does not tell.
bool moves_steadily(const RunSignals& signals, Eigen::Index j) {
  for (Side side : kSides) {
    const bool has_noise_taken_off = signals.period_s <= kLongestNoisePeriod_s;
    const bool stands = (!has_noise_taken_off || signals.wheel_acceleration_rad_s2[side][j] == 0) &&
                        std::abs(signals.wheel_speed_rad_s[side][j]) < kBlurredWheel_rad_s;
    if (!stands && !signals.turning[side][static_cast<std::size_t>(j)]) return false;
  }
  return true;
}

/// Motor power whose sign is in doubt as the supply counts it: it changes within the kernel, or the current
/// is below its ripple, which no sample of a log shows.
double mixed_W(const PowerSupply& supply, const Prediction& prediction, Eigen::Index j) {
  Sided<double> mean_W, change_W;
  for (Side side : kSides) {
    mean_W[side] = prediction.power_W[side][j];
    change_W[side] =
        std::hypot(prediction.power_change_W[side][j], kBlurredCurrent_A * prediction.voltage_V[side][j]);
  }
  return supply_shares(supply.sharing, mean_W, change_W).mixed_W;
}

/// Doubt about a predicted mean of V i, where the acceleration may jump. The variance of a jump of size 1 is
/// 1/4, its slope tells 1/(2 pi).
double jump_W(const Prediction& prediction, Eigen::Index j) {
  constexpr double kOfAJump = std::numbers::pi / 2 - 1;
  double product_W = 0;
  for (Side side : kSides)
    product_W +=
        std::abs(prediction.power_W[side][j] - prediction.voltage_V[side][j] * prediction.current_A[side][j]);
  return kOfAJump * product_W;
}

/// Whether the battery's power, as predicted, is steady for so long that a slow reading is no other, whether
/// it is of an instant, a mean since the reading before, or on the line to the next.
bool is_steady(const RunSignals& signals, const Eigen::VectorXd& predicted_W, Eigen::Index j) {
  const auto rows =
      static_cast<Eigen::Index>(std::ceil(signals.reading_period_s.battery_s / signals.period_s));
  if (j < 2 * rows || j + rows >= predicted_W.size()) return false;
  const auto about = predicted_W.segment(j - 2 * rows, 3 * rows + 1);
  return about.maxCoeff() - about.minCoeff() <= kSteadyPower * rms(predicted_W);
}

/// Leaves each reading of a slow battery monitor once.
void keep_readings(const RunSignals& signals, const Prediction& prediction, ResidualRows& rows) {
  if (signals.battery_read.empty()) return;
  for (Eigen::Index j = 0; j < signals.size(); ++j) {
    const bool read = signals.battery_read[static_cast<std::size_t>(j)];
    if (!read || !is_steady(signals, prediction.battery_power_W, j)) rows.present(j, kDriverPower) = false;
    if (!read) rows.present(j, kSupplyVoltage) = false;
  }
}

/// The battery's power less standby and what the motors take, which the log shows, or else the model. Rows
/// count where doubt about what the motors take changes it by less than its resolution.
void fill_driver(const RunSignals& signals, const ModelPoint& point, const Prediction& prediction,
                 ResidualRows& rows) {
  const Eigen::Index n = signals.size();
  const SupplyAccount& motors = signals.motors_at_supply;
  const bool shown = rows.present.col(kWindingLeft).any() && rows.present.col(kWindingRight).any() &&
                     signals.motor_current_A.left.size() == n && signals.motor_current_A.right.size() == n;
  if (!shown && measures_motors(signals)) return;
  const double recovered = point.robot.power.regeneration_efficiency,
               least_W = kResolution * rms(signals.battery_power_W);
  Eigen::VectorXd driver_W = signals.battery_power_W - prediction.battery_power_W;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (shown)
      driver_W[j] +=
          supply_W(signals, point.robot.power, prediction, j) - motors.supply_W(point.robot.power, j);
    const double doubt_W =
        shown ? (1 - recovered) * motors.mixed_W[j]
              : (1 - recovered) * mixed_W(point.robot.power, prediction, j) + jump_W(prediction, j);
    rows.present(j, kDriverPower) = doubt_W <= least_W && (shown || moves_steadily(signals, j));
  }
  rows.value.col(kDriverPower) = driver_W;
}

void fill_supply(const RunSignals& signals, const ModelPoint& point, const Prediction& prediction,
                 ResidualRows& rows) {
  const Eigen::Index n = signals.size();
  if (signals.battery_power_W.size() == n && n > 0) fill_driver(signals, point, prediction, rows);
  if (signals.battery_voltage_V.size() == n && signals.battery_current_A.size() == n && n > 0 &&
      std::isfinite(point.robot.battery.open_circuit_voltage_V))
    fill(kSupplyVoltage, signals.battery_voltage_V - prediction.battery_voltage_V, rows);
  keep_readings(signals, prediction, rows);
}

void fill_motion(const RunSignals& signals, const Prediction& prediction, ResidualRows& rows) {
  const Eigen::Index n = signals.size();
  if (signals.gyro_yaw_rate_rad_s.size() == n && n > 0)
    fill(kGyro, signals.gyro_yaw_rate_rad_s - prediction.yaw_rate_rad_s, rows);
  if (signals.heading_measured) fill(kHeading, signals.heading_rad - prediction.heading_rad, rows);
  if (signals.heading_measured && signals.x_m.size() == n && n > 0) {
    fill(kPositionX, signals.x_m - prediction.x_m, rows);
    fill(kPositionY, signals.y_m - prediction.y_m, rows);
  }
  remove_pose_means(rows.value);
}

}  // namespace

void remove_pose_means(Eigen::MatrixXd& rows) {
  if (rows.rows() == 0) return;
  for (Channel pose : {kHeading, kPositionX, kPositionY}) rows.col(pose).array() -= rows.col(pose).mean();
}

ResidualRows residual_rows(const RunSignals& signals, const ModelPoint& point, const Prediction& prediction) {
  ResidualRows rows{.value = Eigen::MatrixXd::Zero(signals.size(), kChannelCount)};
  rows.present.setConstant(signals.size(), kChannelCount, false);
  for (Side side : kSides) fill_motor(signals, prediction, side, rows);
  fill_supply(signals, point, prediction, rows);
  fill_motion(signals, prediction, rows);
  return rows;
}

Eigen::MatrixXd signature_rows(const RunSignals& signals, const ModelPoint& point, const Prediction& base,
                               const Prediction& changed) {
  const Eigen::Index n = base.heading_rad.size();
  Eigen::MatrixXd rows(n, kChannelCount);
  Eigen::VectorXd driver_W = changed.battery_power_W - base.battery_power_W;
  if (measures_motors(signals))
    for (Eigen::Index j = 0; j < n; ++j)
      driver_W[j] -=
          supply_W(signals, point.robot.power, changed, j) - supply_W(signals, point.robot.power, base, j);
  for (Side side : kSides) {
    const int s = side == Side::left ? 0 : 1;
    const Eigen::VectorXd current = changed.current_A[side] - base.current_A[side];
    const Eigen::VectorXd voltage = changed.voltage_V[side] - base.voltage_V[side];
    rows.col(kCurrentLeft + s) = current;
    rows.col(kWindingLeft + s) = voltage;
    if (signals.motor_current_A[side].size() == n)
      rows.col(kWindingLeft + s) -= base.reading_resistance_ohm[side].cwiseProduct(current);
  }
  rows.col(kDriverPower) = driver_W;
  rows.col(kSupplyVoltage) = changed.battery_voltage_V - base.battery_voltage_V;
  rows.col(kGyro) = changed.yaw_rate_rad_s - base.yaw_rate_rad_s;
  rows.col(kHeading) = changed.heading_rad - base.heading_rad;
  rows.col(kPositionX) = changed.x_m - base.x_m;
  rows.col(kPositionY) = changed.y_m - base.y_m;
  remove_pose_means(rows);
  return rows;
}

}  // namespace joulepath
