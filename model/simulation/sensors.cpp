#include "model/simulation/sensors.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include "model/channel_delay.hpp"
// Design: docs/decisions/0061-logs-are-means.md
namespace joulepath {
namespace {

double rounded_to(double value, double resolution) {
  return resolution > 0 ? std::round(value / resolution) * resolution : value;
}

}  // namespace

SensorSettings typical_sensors() {
  return {.encoder_counts_per_revolution = 20000,
          .wheel_speed_noise_rad_s = 0.005,
          .voltage_noise_V = 0.02,
          .current_noise_A = 0.01,
          .current_resolution_A = 0.001,
          .voltage_resolution_V = 0.001,
          .gyro_noise_rad_s = 0.002,
          .position_noise_m = 0.002,
          .heading_noise_rad = 0.001};
}

Trajectory read_sensors(const std::vector<Snapshot>& truth, const SensorSettings& settings, bool has_battery,
                        std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noisy = [&](double value, double sigma) {
    return value + (sigma > 0 ? sigma * normal(random) : 0.0);
  };
  const double count_rad = settings.encoder_counts_per_revolution > 0
                               ? 2 * std::numbers::pi / settings.encoder_counts_per_revolution
                               : 0.0;
  Trajectory log;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Snapshot& now = truth[i];
    const Snapshot& before = truth[i - 1];
    const double period_s = now.time_s - before.time_s;
    const auto mean = [&](std::size_t index) { return (now.state[index] - before.state[index]) / period_s; };
    log.time_s.push_back(now.time_s);
    for (Side side : kSides) {
      const std::size_t k = static_cast<std::size_t>(side == Side::right);
      const double turned_rad = rounded_to(now.state[kAngleLeft + k], count_rad) -
                                rounded_to(before.state[kAngleLeft + k], count_rad);
      log.wheel_speed_rad_s[side].push_back(noisy(turned_rad / period_s, settings.wheel_speed_noise_rad_s));
      log.motor_voltage_V[side].push_back(
          rounded_to(noisy(mean(kVoltSeconds + k), settings.voltage_noise_V), settings.voltage_resolution_V));
      log.motor_current_A[side].push_back(
          rounded_to(noisy(mean(kCharge + k), settings.current_noise_A), settings.current_resolution_A));
    }
    if (has_battery) {
      log.battery_voltage_V.push_back(rounded_to(noisy(mean(kBatteryVoltSeconds), settings.voltage_noise_V),
                                                 settings.voltage_resolution_V));
      log.battery_current_A.push_back(
          rounded_to(noisy(mean(kBatteryCharge), settings.current_noise_A), settings.current_resolution_A));
    }
    log.gyro_yaw_rate_rad_s.push_back(noisy(mean(kYaw), settings.gyro_noise_rad_s));
    log.position_x_m.push_back(noisy(now.state[kX], settings.position_noise_m));
    log.position_y_m.push_back(noisy(now.state[kY], settings.position_noise_m));
    log.heading_rad.push_back(noisy(now.state[kYaw], settings.heading_noise_rad));
    log.command_linear_speed_m_s.push_back(now.command_speed_m_s);
    log.command_angular_speed_rad_s.push_back(now.command_yaw_rate_rad_s);
    log.payload_kg.push_back(now.payload_kg);
  }
  if (settings.electrical_delay_s != 0.0 && log.size() > 1)
    delay_motor_channels(log, settings.electrical_delay_s);
  return log;
}

}  // namespace joulepath
