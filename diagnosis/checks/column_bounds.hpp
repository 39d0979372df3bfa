#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// The bounds of a robot: far beyond what its battery drives through its windings at standstill and what its
/// wheels turn without a load, and never beyond those of any robot. The same for a log in a file and for one
/// that arrives row by row.
[[nodiscard]] inline std::array<ColumnBound, 12> column_bounds(const Robot& robot) {
  const auto volt = [&](Side side) {  // infinite: unknown
    return std::min(robot.battery.open_circuit_voltage_V, robot.motor[side].max_voltage_V);
  };
  const auto stall_A = [&](Side side) { return volt(side) / robot.motor[side].resistance_ohm; };
  const auto volts = [&](double of_V) { return std::min(1000.0, kFarBeyond * of_V); };
  const auto amperes = [&](Side side) { return std::min(1000.0, kFarBeyond * stall_A(side)); };
  const auto watts = [&](Side side) { return std::min(1e5, kFarBeyond * volt(side) * stall_A(side)); };
  const auto no_load_rad_s = [&](Side side) {
    return std::min(kFastest_m_s / robot.geometry.wheel_radius_m[side],
                    kFarBeyond * volt(side) / robot.motor[side].volts_per_speed_V_s_rad());
  };
  const double open_V = robot.battery.open_circuit_voltage_V;
  const double battery_A = stall_A(Side::left) + stall_A(Side::right) +
                           (std::isfinite(open_V) ? robot.power.standby_W / open_V : kNoLimit);
  const char* const speed = "degrees per second, rpm or encoder ticks?";
  return {{{"wheel_speed_left_rad_s", no_load_rad_s(Side::left), speed},
           {"wheel_speed_right_rad_s", no_load_rad_s(Side::right), speed},
           {"motor_voltage_left_V", volts(volt(Side::left)), "millivolts?"},
           {"motor_voltage_right_V", volts(volt(Side::right)), "millivolts?"},
           {"motor_current_left_A", amperes(Side::left), "milliamperes?"},
           {"motor_current_right_A", amperes(Side::right), "milliamperes?"},
           {"motor_power_left_W", watts(Side::left), "milliwatts?"},
           {"motor_power_right_W", watts(Side::right), "milliwatts?"},
           {"battery_voltage_V", volts(open_V), "millivolts?"},
           {"battery_current_A", std::min(2000.0, kFarBeyond * battery_A), "milliamperes?"},
           {"gyro_yaw_rate_rad_s", 30, "degrees per second?"},
           {"payload_kg", 1e4, "grams?"}}};
}

/// Least time in which a wheel comes from rest to its greatest speed, by the steepest of the rises that
/// double a speed near the greatest: a single step shows noise. A clock in a smaller unit than seconds makes
/// it minutes.
class QuickestStart {
 public:
  void add(double time_s, double speed_rad_s) {
    const double size_rad_s = std::abs(speed_rad_s);
    const double lasting_rad_s = std::min({size_rad_s, before_rad_s_[0], before_rad_s_[1]});
    before_rad_s_ = {size_rad_s, before_rad_s_[0]};
    most_rad_s_ = std::max(most_rad_s_, lasting_rad_s);
    least_rad_s_ = std::min(least_rad_s_, size_rad_s);
    for (std::size_t k = 0; k < kLevels; ++k) rise_[k].add(time_s, size_rad_s, lasting_rad_s, level_rad_s(k));
  }

  /// Zero for a wheel that never stands or never moves.
  [[nodiscard]] double duration_s() const {
    const Rise* const steepest = steepest_rise();
    return steepest ? most_rad_s_ / steepest->rate_rad_s2 : 0.0;
  }
  [[nodiscard]] bool is_too_slow() const {
    return duration_s() > kLongestStart_s && steepest_rise()->rows > kLeastStartSteps;
  }

 private:
  static constexpr std::size_t kLevels = 24;  ///< up to millions of rad/s
  static constexpr double level_rad_s(std::size_t k) {
    return kMovingWheel_rad_s * static_cast<double>(std::uint64_t{1} << k);
  }

  /// From half a level to the level.
  struct Rise {
    double rate_rad_s2{}, rows{};  ///< of the steepest
    double since_s{std::numeric_limits<double>::quiet_NaN()}, count{};

    void add(double time_s, double size_rad_s, double lasting_rad_s, double level) {
      ++count;
      if (size_rad_s < level / 2) since_s = time_s, count = 0;
      if (std::isnan(since_s) || lasting_rad_s < level) return;
      if (const double rate = level / 2 / (time_s - since_s); rate > rate_rad_s2)
        rate_rad_s2 = rate, rows = count;
      since_s = std::numeric_limits<double>::quiet_NaN();
    }
  };

  [[nodiscard]] const Rise* steepest_rise() const {
    if (!(most_rad_s_ > kMovingWheel_rad_s && least_rad_s_ < kStandingShare * most_rad_s_)) return nullptr;
    const Rise* steepest = nullptr;
    for (std::size_t k = 0; k < kLevels; ++k)
      if (level_rad_s(k) <= most_rad_s_ && 8 * level_rad_s(k) > most_rad_s_ && rise_[k].rate_rad_s2 > 0 &&
          (!steepest || rise_[k].rate_rad_s2 > steepest->rate_rad_s2))
        steepest = &rise_[k];
    return steepest;
  }

  std::array<Rise, kLevels> rise_{};
  std::array<double, 2> before_rad_s_{};
  double most_rad_s_{}, least_rad_s_{std::numeric_limits<double>::infinity()};
};

/// What a clock in another unit looks like, in errors.
inline constexpr const char* kClockHint = "is the stamp in ms (scale 1.0e-3), us (1.0e-6) or ns (1.0e-9)?";

}  // namespace joulepath
