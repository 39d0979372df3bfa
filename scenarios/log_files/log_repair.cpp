#include "scenarios/log_files/log_repair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/log_files/partial_channels.hpp"
// Design: docs/decisions/0601-logs.md
namespace joulepath {
namespace {

constexpr double kGapFactor = 4.0;        // a step longer than this many usual ones is a gap
constexpr std::size_t kHeldSamples = 10;  // equal values in a row that are reported

/// The median step of ascending times. The bits of positive numbers are in the order of the numbers: 16 of
/// them at a time are selected by counts, to spare a copy of a long log.
double median_step(const std::vector<double>& times) {
  constexpr std::size_t kDigits = 1u << 16;
  std::size_t rank = (times.size() - 1) / 2;
  std::uint64_t found = 0;
  for (int shift = 48; shift >= 0; shift -= 16) {
    std::vector<std::size_t> count(kDigits);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      const auto digits = std::bit_cast<std::uint64_t>(times[i + 1] - times[i]) >> shift;
      if (digits / kDigits == found) ++count[digits % kDigits];
    }
    std::uint64_t digit = 0;
    while (rank >= count[digit]) rank -= count[digit++];
    found = found * kDigits + digit;
  }
  return std::bit_cast<double>(found);
}

std::string seconds(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g s", value);
  return buffer;
}

void find_gaps(const Trajectory& log, const std::string& run, std::vector<LogArtifact>& artifacts) {
  const double usual_s = median_step(log.time_s);
  LogArtifact gap{.kind = "clock_jump", .run = run, .channel = "time_s"};
  double longest_s = 0.0;
  for (std::size_t i = 0; i + 1 < log.size(); ++i) {
    const double step_s = log.time_s[i + 1] - log.time_s[i];
    if (step_s <= kGapFactor * usual_s) continue;
    if (gap.count++ == 0) gap.first_time_s = log.time_s[i];
    longest_s = std::max(longest_s, step_s);
  }
  if (gap.count == 0) return;
  gap.description = "steps of the clock up to " + seconds(longest_s) + " where " + seconds(usual_s) +
                    " is usual: samples are missing, or the clock jumped";
  artifacts.push_back(gap);
}

/// Number of different values of a channel; a part of them at a time, to spare a copy of a long log.
std::size_t distinct(const std::vector<double>& values) {
  constexpr std::uint64_t kParts = 16, kMixing = 0x9E3779B97F4A7C15;
  const auto part_of = [](double value) {  // 0 and -0 are one value
    return (std::bit_cast<std::uint64_t>(value + 0.0) * kMixing >> 32) % kParts;
  };
  std::size_t count = 0;
  std::vector<double> part;
  for (std::uint64_t k = 0; k < kParts; ++k) {
    part.clear();
    std::ranges::copy_if(values, std::back_inserter(part), [&](double value) { return part_of(value) == k; });
    std::ranges::sort(part);
    count += static_cast<std::size_t>(std::unique(part.begin(), part.end()) - part.begin());
  }
  return count;
}

/// A sensor with coarse steps repeats values regularly; one with fine steps rarely does.
bool has_fine_steps(const std::vector<double>& values, std::size_t changes) {
  return 10 * distinct(values) > 9 * changes;
}

/// Whether the sensor of a channel is slower than its log: it usually repeats a value.
bool is_slow(const Holds& holds) { return holds.count >= 30 && holds.median_length() >= 2; }

/// Whether another channel changed all the time: then the sensor stopped, not the robot.
bool changes_during(const std::vector<double>& times, const std::vector<double>& witness, const Hold& hold) {
  const auto row_at = [&](auto place) { return static_cast<std::size_t>(place - times.begin()); };
  const std::size_t first = row_at(std::ranges::lower_bound(times, hold.from_s)),
                    end = row_at(std::ranges::upper_bound(times, hold.to_s));
  if (end < first + 2) return false;
  std::size_t changes = 0;
  for (std::size_t i = first + 1; i < end; ++i)
    if (witness[i] != witness[i - 1]) ++changes;
  return 10 * changes >= 9 * (end - first - 1);
}

/// A value that stays exactly the same while a wheel's speed changes.
std::optional<LogArtifact> held_values(const Trajectory& log, const LogArtifact& of, const Holds& holds,
                                       const std::vector<double>& witness) {
  LogArtifact held = of;
  std::size_t longest = 0;
  for (const Hold& hold : holds.of_reported_length) {
    if (!changes_during(log.time_s, witness, hold)) continue;
    if (held.count == 0) held.first_time_s = hold.from_s;
    held.count += hold.length;
    longest = std::max(longest, hold.length);
  }
  if (held.count == 0) return {};
  held.kind = "held_value";
  held.description =
      "the same value " + std::to_string(longest) +
      " samples in a row while the robot's speed changed: the sensor or the logger may have stopped";
  return held;
}

/// A channel that repeats every value in several rows: its sensor is slower than the log.
std::optional<LogArtifact> slow_channel(const LogArtifact& of, const Holds& holds) {
  if (!is_slow(holds)) return {};
  LogArtifact slow = of;
  slow.kind = "slow_channel";
  slow.count = holds.count;
  slow.description = "a new value only at every " + std::to_string(holds.median_length()) +
                     ". row: the channel is slower than the log";
  return slow;
}

/// The position as one channel: 0 while the robot stands, else a new number for every new place.
std::vector<double> places(const Trajectory& log) {
  std::vector<double> place(log.position_x_m.size());
  double fastest_rad_s = 0.0, number = 1.0;
  const auto speed_rad_s = [&](std::size_t i) {
    return 0.5 * (log.wheel_speed_rad_s.left[i] + log.wheel_speed_rad_s.right[i]);
  };
  for (std::size_t i = 0; i < place.size(); ++i)
    fastest_rad_s = std::max(fastest_rad_s, std::abs(speed_rad_s(i)));
  for (std::size_t i = 0; i < place.size(); ++i) {
    const bool same = i > 0 && log.position_x_m[i] == log.position_x_m[i - 1] &&
                      log.position_y_m[i] == log.position_y_m[i - 1];
    if (!same) ++number;
    place[i] = std::abs(speed_rad_s(i)) > 0.05 * fastest_rad_s ? number : 0.0;
  }
  return place;
}

void find_stuck(const Trajectory& log, const LogArtifact& of, const Holds& holds,
                const std::vector<double>& witness, std::vector<LogArtifact>& artifacts) {
  if (!holds.fine_steps) return;
  if (const auto held = held_values(log, of, holds, witness)) artifacts.push_back(*held);
  if (const auto slow = slow_channel(of, holds)) artifacts.push_back(*slow);
}

/// Heading, temperature, payload and commands may stay constant for long; other measured channels may not.
bool may_stay(const LogColumn& column) {
  for (const char* name :
       {"time_s", "payload_kg", "temperature_C", "heading_rad", "position_x_m", "position_y_m",
        "motor_voltage_left_V", "motor_voltage_right_V"})  // a voltage step is a test, no held value
    if (column.name == name) return true;
  return !column.measured || column.name.rfind("command_", 0) == 0;
}

}  // namespace

std::size_t unwrap_counter(std::vector<double>& values, double wraps_at) {
  std::size_t wraps = 0;
  double lift = 0.0;
  double previous = values.empty() ? 0.0 : values.front();
  for (double& value : values) {
    if (!std::isfinite(value)) continue;
    const double step = value - previous;
    previous = value;
    if (std::abs(step) > 0.5 * wraps_at) {
      lift -= std::copysign(wraps_at, step);
      ++wraps;
    }
    value += lift;
  }
  return wraps;
}

void unwrap_angle(std::vector<double>& values) {
  constexpr double turn = 2.0 * std::numbers::pi;
  double previous = std::numeric_limits<double>::quiet_NaN();
  for (double& value : values) {
    if (!std::isfinite(value)) continue;
    if (std::isfinite(previous)) value -= turn * std::round((value - previous) / turn);
    previous = value;
  }
}

std::vector<double> interpolated(const std::vector<double>& times, const std::vector<double>& values,
                                 const std::vector<double>& at) {
  std::vector<double> result(at.size());
  std::size_t k = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    while (k > 0 && times[k] > at[i]) --k;
    while (k + 2 < times.size() && times[k + 1] < at[i]) ++k;
    if (times.size() < 2) {
      result[i] = values.front();
      continue;
    }
    const double share = std::clamp((at[i] - times[k]) / (times[k + 1] - times[k]), 0.0, 1.0);
    result[i] = share < 1.0 ? values[k] + share * (values[k + 1] - values[k]) : values[k + 1];  // exact there
  }
  return result;
}

std::vector<double> change_per_second(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> result(values.size());
  for (std::size_t i = 1; i < values.size(); ++i)
    result[i] = (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
  if (values.size() > 1) result[0] = result[1];
  return result;
}

KnownTime::KnownTime(const std::vector<double>& times) {
  const double step_s = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  begin_s = times.front() - step_s, end_s = times.back() + step_s;
}

std::size_t fill_missing(const std::vector<double>& times, std::vector<double>& values, Ends ends) {
  if (std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return 0;
  std::vector<double> known_times, known_values;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) {
      known_times.push_back(times[i]);
      known_values.push_back(values[i]);
    }
  std::size_t missing = values.size() - known_values.size();
  if (known_values.size() < (ends == Ends::held ? 1u : 2u)) {
    values.clear();
    return missing;
  }
  values = interpolated(known_times, known_values, times);
  if (ends == Ends::held) return missing;
  const KnownTime own(known_times);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!own.covers(times[i])) values[i] = std::numeric_limits<double>::quiet_NaN(), --missing;
  return missing;
}

std::size_t Holds::median_length() const {
  std::size_t below = 0;
  for (const auto& [length, number] : count_of_length)
    if ((below += number) > count / 2) return length;
  return 0;
}

Holds holds_of(const std::vector<double>& times, const std::vector<double>& readings) {
  Holds holds;
  std::size_t start = 0, singles = 0;
  for (std::size_t i = 1; i <= readings.size(); ++i) {
    if (i < readings.size() && readings[i] == readings[start]) continue;
    const Hold hold{times[start], times[i - 1], i - start};
    const bool at_rest = readings[start] == 0.0;
    start = i;
    if (at_rest) continue;
    ++holds.count;
    if (hold.length == 1)
      ++singles;
    else
      ++holds.count_of_length[hold.length];
    if (hold.length >= kHeldSamples) holds.of_reported_length.push_back(hold);
  }
  if (singles > 0) holds.count_of_length[1] = singles;
  holds.fine_steps =
      (is_slow(holds) || !holds.of_reported_length.empty()) && has_fine_steps(readings, holds.count);
  return holds;
}

std::vector<LogArtifact> find_artifacts(Trajectory& trajectory, const HoldsOfChannel& of_own_readings,
                                        const std::string& run) {
  std::vector<LogArtifact> artifacts;
  if (trajectory.size() < 3) return artifacts;
  find_gaps(trajectory, run, artifacts);
  const Sided<std::vector<double>>& wheels = trajectory.wheel_speed_rad_s;
  if (wheels.left.empty() || wheels.right.empty()) return artifacts;
  for (const auto& column : log_columns()) {
    const std::vector<double>& values = column.channel(trajectory);
    if (values.empty() || may_stay(column)) continue;
    const auto& witness = &values == &wheels.left ? wheels.right : wheels.left;
    const auto own = of_own_readings.find(column.name);
    if (is_partial(values) && own == of_own_readings.end()) continue;
    find_stuck(trajectory, {.run = run, .channel = column.name},
               own == of_own_readings.end() ? holds_of(trajectory.time_s, values) : own->second, witness,
               artifacts);
  }
  if (!trajectory.position_x_m.empty() && !trajectory.position_y_m.empty() &&
      !is_partial(trajectory.position_x_m))
    find_stuck(trajectory, {.run = run, .channel = "position_x_m"},
               holds_of(trajectory.time_s, places(trajectory)), wheels.left, artifacts);
  return artifacts;
}

}  // namespace joulepath
