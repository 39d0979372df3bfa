#include "diagnosis/signals/held_readings.hpp"

#include <algorithm>
#include <array>
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

/// Where a channel changes its value, but for the first time.
struct Changes {
  std::vector<std::size_t> apart{};  ///< samples since the change before
  Samples by{};

  /// Samples for which each value stays; 1 where too few of them, or of the changes, tell.
  std::size_t hold() const {
    if (apart.size() < kLeastReadings) return 1;
    const std::size_t least = lower_tenth(apart);
    const auto regular =
        std::ranges::count_if(apart, [&](std::size_t n) { return n == least || n == least + 1; });
    return regular < kRegularReadings * static_cast<double>(apart.size()) ? 1 : least;
  }
  /// As of a channel that is rounded to steps.
  bool are_steps() const {
    return apart.size() >= kLeastReadings && upper_median(by) < kOfOneStep * lower_tenth(by);
  }
};

Changes changes_of(const Samples& channel) {
  constexpr std::size_t kManyReadings = 2000;  // a long log need not be read to its end
  Changes changes;
  std::size_t last = 0;
  for (std::size_t i = 1; i < channel.size() && changes.apart.size() < kManyReadings; ++i)
    if (channel[i] != channel[i - 1]) {
      if (last > 0)
        changes.apart.push_back(i - last), changes.by.push_back(std::abs(channel[i] - channel[i - 1]));
      last = i;
    }
  return changes;
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

/// A pose is one reading: its channels hold together, also a heading that turns steadily and so changes in
/// steps that are all alike. Poses that are far apart stay: a line is not the way between them, and what
/// reads them looks for readings.
void draw_lines(Trajectory& log) {
  if (log.size() < 2) return;
  const double period_s = (log.time_s.back() - log.time_s.front()) / static_cast<double>(log.size() - 1);
  const std::array pose{&log.position_x_m, &log.position_y_m, &log.heading_rad};
  const bool pose_holds =
      std::ranges::any_of(pose, [](const Samples* channel) { return hold_of(*channel) > 1; });
  if (pose_holds) log.heading_rad = unwrap_angle(log.heading_rad);
  for_each_reading(log, [&](Samples& channel) {
    const bool is_pose = std::ranges::count(pose, &channel) > 0;
    const std::size_t hold = is_pose && pose_holds ? changes_of(channel).hold() : hold_of(channel);
    const bool is_apart = static_cast<double>(hold) * period_s > kBlurredReadings * kKernelSigma_s;
    if (hold > 1 && !(is_pose && is_apart)) channel = lines_between(channel, hold);
  });
}

}  // namespace

std::size_t hold_of(const Samples& channel) {
  const Changes changes = changes_of(channel);
  return changes.are_steps() ? 1 : changes.hold();
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
