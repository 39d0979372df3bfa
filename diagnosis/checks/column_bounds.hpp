#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "diagnosis/thresholds.hpp"
#include "model/robot.hpp"

namespace joulepath {

/// Greatest absolute value of a log's column that a robot can have.
struct ColumnBound {
  std::string_view column{};
  double most{};
  const char* hint{};  ///< the likely slip
};

/// The bounds of a robot: far beyond what its battery drives through its windings at standstill, and never
/// beyond those of any robot. The same for a log in a file and for one that arrives row by row.
[[nodiscard]] inline std::array<ColumnBound, 10> column_bounds(const Robot& robot) {
  const double volt = robot.battery.open_circuit_voltage_V;  // infinite: unknown
  const auto stall_A = [&](Side side) { return volt / robot.motor[side].resistance_ohm; };
  const auto amperes = [&](Side side) { return std::min(1000.0, kFarBeyond * stall_A(side)); };
  const auto watts = [&](Side side) { return std::min(1e5, kFarBeyond * volt * stall_A(side)); };
  const double most_V = std::min(1000.0, kFarBeyond * volt);
  const double battery_A = stall_A(Side::left) + stall_A(Side::right) + robot.power.standby_W / volt;
  return {{{"motor_voltage_left_V", most_V, "millivolts?"},
           {"motor_voltage_right_V", most_V, "millivolts?"},
           {"motor_current_left_A", amperes(Side::left), "milliamperes?"},
           {"motor_current_right_A", amperes(Side::right), "milliamperes?"},
           {"motor_power_left_W", watts(Side::left), "milliwatts?"},
           {"motor_power_right_W", watts(Side::right), "milliwatts?"},
           {"battery_voltage_V", most_V, "millivolts?"},
           {"battery_current_A", std::min(2000.0, kFarBeyond * battery_A), "milliamperes?"},
           {"gyro_yaw_rate_rad_s", 30, "degrees per second?"},
           {"payload_kg", 1e4, "grams?"}}};
}

/// Least time in which a wheel comes from rest to its greatest speed, by the steepest of its steps so far. A
/// clock in a smaller unit than seconds makes it minutes.
class QuickestStart {
 public:
  void add(double time_s, double speed_rad_s) {
    const double size_rad_s = std::abs(speed_rad_s);
    most_rad_s_ = std::max(most_rad_s_, size_rad_s), least_rad_s_ = std::min(least_rad_s_, size_rad_s);
    if (const double step_s = time_s - last_s_; step_s > 0) {
      const double change_rad_s = std::abs(speed_rad_s - last_rad_s_);
      step_rad_s_ = std::max(step_rad_s_, change_rad_s);
      rate_rad_s2_ = std::max(rate_rad_s2_, change_rad_s / step_s);
    }
    last_s_ = time_s, last_rad_s_ = speed_rad_s;
  }

  /// Zero for a wheel that never stands or never moves.
  [[nodiscard]] double duration_s() const {
    const bool starts = most_rad_s_ > kMovingWheel_rad_s && least_rad_s_ < kStandingShare * most_rad_s_;
    return starts ? most_rad_s_ / rate_rad_s2_ : 0.0;
  }
  [[nodiscard]] bool is_too_slow() const {
    return duration_s() > kLongestStart_s && most_rad_s_ > kLeastStartSteps * step_rad_s_;
  }

 private:
  double most_rad_s_{}, least_rad_s_{std::numeric_limits<double>::infinity()}, step_rad_s_{}, rate_rad_s2_{};
  double last_s_{std::numeric_limits<double>::infinity()}, last_rad_s_{};
};

/// What a clock in another unit looks like, in errors.
inline constexpr const char* kClockHint = "is the stamp in ms (scale 1.0e-3), us (1.0e-6) or ns (1.0e-9)?";

}  // namespace joulepath
