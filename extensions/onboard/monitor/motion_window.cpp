#include "extensions/onboard/monitor/motion_window.hpp"

#include <algorithm>
#include <cmath>

#include "model/kinematics.hpp"

namespace joulepath {
namespace {

constexpr double kTurning_rad_s = 0.3;    ///< below it the direction of dry friction is uncertain
constexpr double kShortest_s = 0.3;       ///< window
constexpr double kLongest_s = 1.5;        ///< window
constexpr double kPeriodsPerWindow = 12;  ///< at least, where kLongest_s allows
constexpr std::size_t kLeastRows = 5;
constexpr double kGapPeriods = 4;  ///< a longer step is a gap
constexpr double kForgetting = 0.02;

/// Sums of one channel with the window's weights and with their derivative.
struct Weighted {
  double mean{}, slope{};
  void add(double value, double weight, double derivative) {
    mean += weight * value;
    slope += derivative * value;
  }
};

double spacing(const std::vector<MonitorRow>& rows, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, rows.size() - 1);
  return 0.5 * (rows[after].time_s - rows[before].time_s);
}

}  // namespace

bool MotionWindows::begins_or_continues(const MonitorRow& row) const {
  for (const Side side : kSides) {
    if (!(std::abs(row.wheel_speed_rad_s[side]) > kTurning_rad_s)) return false;
    if (rows_.empty()) continue;
    if (row.wheel_speed_rad_s[side] * rows_.front().wheel_speed_rad_s[side] < 0) return false;
  }
  return rows_.size() < kMostRows;
}

void MotionWindows::learn_period(double step_s) {
  if (std::isnan(period_s_))
    period_s_ = step_s;
  else  // towards the median: a gap moves it no more than a short step does
    period_s_ *= 1 + (step_s > period_s_ ? kForgetting : -kForgetting);
}

std::optional<WindowMean> MotionWindows::add(const MonitorRow& row) {
  const double step_s = row.time_s - last_s_;
  last_s_ = row.time_s;
  if (step_s > 0) learn_period(step_s);
  if (step_s > kGapPeriods * period_s_) rows_.clear();
  if (!begins_or_continues(row)) {
    rows_.clear();
    if (begins_or_continues(row)) rows_.push_back(row);
    return std::nullopt;
  }
  rows_.push_back(row);
  const double wanted_s = std::clamp(kPeriodsPerWindow * period_s_, kShortest_s, kLongest_s);
  if (row.time_s - rows_.front().time_s < wanted_s) return std::nullopt;
  std::optional<WindowMean> window = rows_.size() >= kLeastRows ? mean() : std::nullopt;
  rows_.assign(1, row);
  return window;
}

std::optional<WindowMean> MotionWindows::mean() const {
  const double begin_s = rows_.front().time_s, end_s = rows_.back().time_s, length_s = end_s - begin_s;
  Weighted speed, yaw_rate, left_A, right_A, battery_W, heading, clock;
  double weights = 0, derivatives = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const MonitorRow& row = rows_[i];
    const double u = (row.time_s - begin_s) / length_s, step_s = spacing(rows_, i);
    const double weight = u * (1 - u) * step_s, derivative = (1 - 2 * u) * step_s;
    const Twist<double> twist = body_twist(geometry_, row.wheel_speed_rad_s);
    speed.add(twist.speed_m_s, weight, derivative);
    yaw_rate.add(twist.yaw_rate_rad_s, weight, derivative);
    left_A.add(row.motor_current_A.left, weight, 0);
    right_A.add(row.motor_current_A.right, weight, 0);
    battery_W.add(row.battery_voltage_V * row.battery_current_A, weight, 0);
    heading.add(std::isnan(row.heading_rad) ? 0.0 : row.heading_rad, weight, 0);
    clock.add(row.time_s - begin_s, weight, derivative);
    weights += weight;
    derivatives += derivative;
  }
  if (!(weights > 0)) return std::nullopt;
  // Normalized so that a constant has slope 0 and a straight line its own, on uneven rows too.
  const auto slope = [&](const Weighted& x) {
    const double level = x.mean / weights, middle_s = clock.mean / weights;
    return (x.slope - derivatives * level) / (clock.slope - derivatives * middle_s);
  };
  const MonitorRow& first = rows_.front();
  return WindowMean{
      .begin_s = begin_s,
      .end_s = end_s,
      .motion = {speed.mean / weights, slope(speed), yaw_rate.mean / weights, slope(yaw_rate)},
      .wheel_direction = {sign_of(first.wheel_speed_rad_s.left), sign_of(first.wheel_speed_rad_s.right)},
      .current_A = {left_A.mean / weights, right_A.mean / weights},
      .battery_power_W = battery_W.mean / weights,
      .heading_rad = heading.mean / weights};
}

}  // namespace joulepath
