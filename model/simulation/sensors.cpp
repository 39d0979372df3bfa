#include "model/simulation/sensors.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "model/channel_delay.hpp"
// Design: docs/decisions/0102-simulation.md
namespace joulepath {
namespace {

double rounded_to(double value, double resolution) {
  return resolution > 0 ? std::round(value / resolution) * resolution : value;
}

/// Readings of one simulation in the order in which their noise is drawn.
class Readings {
 public:
  Readings(const SensorSettings& settings, bool has_battery, std::uint64_t seed)
      : settings_(settings), has_battery_(has_battery), random_(seed), phase_(encoder_phase(seed)) {}

  void add(const Snapshot& before, const Snapshot& now) {
    log_.time_s.push_back(now.time_s);
    add_motors(before, now);
    if (has_battery_) {
      log_.battery_voltage_V.push_back(voltage_V(mean(before, now, kBatteryVoltSeconds)));
      log_.battery_current_A.push_back(current_A(mean(before, now, kBatteryCharge)));
    }
    log_.gyro_yaw_rate_rad_s.push_back(noisy(mean(before, now, kYaw), settings_.gyro_noise_rad_s));
    log_.position_x_m.push_back(noisy(now.state[kX], settings_.position_noise_m));
    log_.position_y_m.push_back(noisy(now.state[kY], settings_.position_noise_m));
    log_.heading_rad.push_back(noisy(now.state[kYaw], settings_.heading_noise_rad));
    log_.command_linear_speed_m_s.push_back(now.command_speed_m_s);
    log_.command_angular_speed_rad_s.push_back(now.command_yaw_rate_rad_s);
    log_.payload_kg.push_back(now.payload_kg);
  }

  Trajectory log() && { return std::move(log_); }

 private:
  void add_motors(const Snapshot& before, const Snapshot& now) {
    const double count_rad = settings_.encoder_counts_per_revolution > 0
                                 ? 2 * std::numbers::pi / settings_.encoder_counts_per_revolution
                                 : 0.0;
    for (Side side : kSides) {
      const std::size_t k = static_cast<std::size_t>(side == Side::right);
      const auto counted_rad = [&](const Snapshot& at) {
        return rounded_to(phase_[side] * count_rad + at.state[kAngleLeft + k], count_rad);
      };
      const double turned_rad = counted_rad(now) - counted_rad(before);
      log_.wheel_speed_rad_s[side].push_back(
          noisy(turned_rad / (now.time_s - before.time_s), settings_.wheel_speed_noise_rad_s));
      log_.motor_voltage_V[side].push_back(voltage_V(mean(before, now, kVoltSeconds + k)));
      log_.motor_current_A[side].push_back(current_A(mean(before, now, kCharge + k)));
    }
  }

  /// Where in a count each encoder begins, 0 to 1: repeated runs do not share their rounding.
  static Sided<double> encoder_phase(std::uint64_t seed) {
    std::mt19937_64 random(~seed);  // apart from the noise
    std::uniform_real_distribution<double> phase;
    const double left = phase(random);
    return {left, phase(random)};
  }

  static double mean(const Snapshot& before, const Snapshot& now, std::size_t index) {
    return (now.state[index] - before.state[index]) / (now.time_s - before.time_s);
  }

  double noisy(double value, double sigma) { return value + (sigma > 0 ? sigma * normal_(random_) : 0.0); }
  double voltage_V(double mean) {
    return rounded_to(noisy(mean, settings_.voltage_noise_V), settings_.voltage_resolution_V);
  }
  double current_A(double mean) {
    return rounded_to(noisy(mean, settings_.current_noise_A), settings_.current_resolution_A);
  }

  const SensorSettings& settings_;
  bool has_battery_{};
  std::mt19937_64 random_;
  Sided<double> phase_{};
  std::normal_distribution<double> normal_{};
  Trajectory log_{};
};

}  // namespace

std::uint64_t seed_of_run(std::uint64_t seed, std::uint64_t run) {
  if (run == 0) return seed;
  const auto spread = [](std::uint64_t x) {  // the finalizer of splitmix64, of public domain
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
  };
  return spread(spread(seed) + run) >> 11;
}

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
  Readings readings(settings, has_battery, seed);
  for (std::size_t i = 1; i < truth.size(); ++i) readings.add(truth[i - 1], truth[i]);
  Trajectory log = std::move(readings).log();
  if (settings.electrical_delay_s != 0.0 && log.size() > 1)
    delay_motor_channels(log, settings.electrical_delay_s);
  return log;
}

}  // namespace joulepath
