#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "extensions/onboard/monitor/monitor_row.hpp"
#include "model/motion.hpp"
#include "model/robot.hpp"

namespace joulepath {

/// Weighted means of a short piece of a log in which both wheels turn in one direction.
struct WindowMean {
  double begin_s{};
  double end_s{};
  BodyMotion<double> motion{};
  Sided<double> wheel_direction{};
  Sided<double> current_A{kAbsent, kAbsent};
  double battery_power_W{kAbsent};
  double heading_rad{};

  /// Standard deviation of the weights below in time.
  [[nodiscard]] double sigma_s() const { return (end_s - begin_s) / std::sqrt(20.0); }
};

/// Cuts a stream of rows into windows. A window begins where both wheels turn; a standstill, a gap or a
/// reversal discards it. All channels are weighted with w(u) = 6 u (1 - u), 0 <= u <= 1, which vanishes at
/// both ends, so that the mean acceleration needs no difference of noisy neighbors:
///
///   int w v' dt = -int w' v dt
///
/// and belongs to the mean current of the same window exactly, whatever the jerk.
class MotionWindows {
 public:
  explicit MotionWindows(const Geometry& geometry) : geometry_(geometry) {}

  /// Takes a row, later than the one before; a window that it completes.
  [[nodiscard]] std::optional<WindowMean> add(const MonitorRow& row);

 private:
  static constexpr std::size_t kMostRows = 4096;  ///< kept: bounds the memory

  [[nodiscard]] bool begins_or_continues(const MonitorRow& row) const;
  void learn_period(double step_s);
  [[nodiscard]] std::optional<WindowMean> mean() const;

  Geometry geometry_;
  std::vector<MonitorRow> rows_{};
  double last_s_{kAbsent};
  double period_s_{kAbsent};
};

}  // namespace joulepath
