#include "diagnosis/signals/held_readings.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/kinematics.hpp"
#include "model/median.hpp"

namespace joulepath {
namespace {

using Samples = std::vector<double>;

/// The value below which a tenth of some values lies.
template <class T>
T lower_tenth(std::vector<T> values) {
  const auto at = values.begin() + std::ssize(values) / 10;
  std::ranges::nth_element(values, at);
  return *at;
}

/// Lines between readings that are `hold` samples apart, or one more. A value that stays longer was read
/// again.
Samples lines_between(const Samples& held, std::size_t hold) {
  Samples lines = held;
  std::size_t last = 0;
  for (std::size_t i = 1; i < held.size(); ++i) {
    if (held[i] == held[last]) continue;
    const std::size_t from = i - last <= hold + 1 ? last : i - hold;
    for (std::size_t k = from + 1; k < i; ++k)
      lines[k] =
          held[from] + (held[i] - held[from]) * static_cast<double>(k - from) / static_cast<double>(i - from);
    last = i;
  }
  return lines;
}

/// Calls visit(channel) for each measured channel; a heading does not jump.
template <class Log, class Visit>
void for_each_reading(Log& log, const Visit& visit) {
  for (Side side : kSides) {
    visit(log.wheel_speed_rad_s[side]);
    for (auto* motor : {&log.motor_voltage_V, &log.motor_current_A, &log.motor_power_W})
      visit((*motor)[side]);
  }
  for (auto* channel :
       {&log.linear_speed_m_s, &log.angular_speed_rad_s, &log.battery_voltage_V, &log.battery_current_A,
        &log.gyro_yaw_rate_rad_s, &log.position_x_m, &log.position_y_m, &log.heading_rad})
    visit(*channel);
}

bool holds_readings(const Trajectory& log) {
  bool any = false;
  for_each_reading(log, [&](const Samples& channel) { any = any || hold_of(channel) > 1; });
  return any;
}

/// Poses that are far apart stay: a line is not the way between them, and what reads them looks for readings.
void draw_lines(Trajectory& log) {
  if (log.size() < 2) return;
  const double period_s = (log.time_s.back() - log.time_s.front()) / static_cast<double>(log.size() - 1);
  if (hold_of(log.heading_rad) > 1) log.heading_rad = unwrap_angle(log.heading_rad);
  for_each_reading(log, [&](Samples& channel) {
    const std::size_t hold = hold_of(channel);
    const bool is_pose =
        &channel == &log.position_x_m || &channel == &log.position_y_m || &channel == &log.heading_rad;
    const bool is_apart = static_cast<double>(hold) * period_s > kBlurredReadings * kKernelSigma_s;
    if (hold > 1 && !(is_pose && is_apart)) channel = lines_between(channel, hold);
  });
}

}  // namespace

std::size_t hold_of(const Samples& channel) {
  constexpr std::size_t kManyReadings = 2000;  // a long log need not be read to its end
  std::vector<std::size_t> lengths;
  Samples jumps;
  std::size_t last = 0;
  for (std::size_t i = 1; i < channel.size() && lengths.size() < kManyReadings; ++i)
    if (channel[i] != channel[i - 1]) {
      if (last > 0) lengths.push_back(i - last), jumps.push_back(std::abs(channel[i] - channel[i - 1]));
      last = i;
    }
  if (lengths.size() < kLeastReadings) return 1;
  const std::size_t hold = lower_tenth(lengths);
  const auto regular =
      std::ranges::count_if(lengths, [&](std::size_t n) { return n == hold || n == hold + 1; });
  const bool is_rounded = upper_median(jumps) < kOfOneStep * lower_tenth(jumps);
  if (hold < 2 || is_rounded || regular < kRegularReadings * static_cast<double>(lengths.size())) return 1;
  return hold;
}

bool holds_readings(const Dataset& dataset) {
  return std::ranges::any_of(dataset.runs, [](const Run& run) {
    return holds_readings(run.log) || (run.predicted && holds_readings(*run.predicted));
  });
}

Dataset between_readings(Dataset dataset) {
  for (Run& run : dataset.runs) {
    draw_lines(run.log);
    if (run.predicted) draw_lines(*run.predicted);
  }
  return dataset;
}

}  // namespace joulepath
