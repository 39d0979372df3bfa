#pragma once

#include <functional>
#include <string>
#include <vector>

#include "logs.hpp"

namespace control {

enum class Channel {
  current_left,
  current_right,
  voltage_left,
  voltage_right,
  yaw,
  forward,
  battery_power,
  battery_voltage
};
inline constexpr int kChannels = 8;

/// One sample of a run, as input of the regressions.
struct Instant {
  const Robot* robot{};
  double payload_kg{}, day_s{};
  Pair q{}, dq{}, amps{}, volts{};  ///< smoothed
  double v{}, w{}, a{}, dw{}, heading{}, battery_A{};
  double sign(std::size_t side) const { return q[side] > 0.05 ? 1.0 : (q[side] < -0.05 ? -1.0 : 0.0); }
  double normal_N() const { return (robot->chassis_kg + 2 * robot->wheel_kg + payload_kg) * 9.80665 / 2; }
};

/// Nominal prediction and measured value of one channel at one instant.
struct Row {
  Channel channel{};
  Instant at{};
  double nominal{}, measured{};
};

/// A column of the sparse regression: its effect and parameter, and its value in a row.
struct Term {
  std::string effect, parameter, side;
  std::function<double(const Row&)> value;
};

/// A sparse regression as an ordinary user would set it up: one linear column per effect, with fixed shapes
/// (Stribeck speed, heating time) if the law is not linear.
[[nodiscard]] std::vector<Term> effect_library(const Robot& robot);

/// One column per parameter of the robot file.
[[nodiscard]] std::vector<Term> parameter_library(const Robot& robot);

/// All rows of a run, every `stride`-th sample.
[[nodiscard]] std::vector<Row> rows_of(const Robot& robot, const Run& run, std::size_t stride);

/// Nominal motor current by the reduced rigid-body equations, and its torque.
[[nodiscard]] double nominal_torque_Nm(const Instant& at, std::size_t side);

}  // namespace control
