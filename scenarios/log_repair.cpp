#include "scenarios/log_repair.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/log_columns.hpp"

namespace joulepath {
namespace {

constexpr double kGapFactor = 4.0;        // a step longer than this many usual ones is a gap
constexpr std::size_t kHeldSamples = 10;  // equal values in a row before it is worth a word

double median_step(const std::vector<double>& times) {
  std::vector<double> steps(times.size() - 1);
  for (std::size_t i = 0; i + 1 < times.size(); ++i) steps[i] = times[i + 1] - times[i];
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
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

/// How many different values a channel has.
std::size_t distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

/// A sensor with coarse steps repeats its values honestly; one with fine steps hardly ever does.
bool has_fine_steps(const std::vector<double>& values, std::size_t changes) {
  return 10 * distinct(values) > 9 * changes;
}

struct HoldStatistics {
  std::size_t changes{};        ///< how often the value changes
  std::size_t longest{};        ///< most equal values in a row, zeros aside
  std::size_t longest_start{};  ///< where that begins
  std::size_t held_samples{};   ///< in all holds of at least kHeldSamples
};

HoldStatistics holds(const std::vector<double>& values) {
  HoldStatistics statistics;
  std::size_t start = 0;
  for (std::size_t i = 1; i <= values.size(); ++i) {
    if (i < values.size() && values[i] == values[start]) continue;
    const std::size_t length = i - start;
    if (values[start] != 0.0) {
      if (length > statistics.longest) statistics.longest = length, statistics.longest_start = start;
      if (length >= kHeldSamples) statistics.held_samples += length;
    }
    ++statistics.changes;
    start = i;
  }
  return statistics;
}

/// A value that stays exactly the same far longer than this channel usually does.
void find_held(const Trajectory& log, const std::string& run, const LogColumn& column,
               const std::vector<double>& values, std::vector<LogArtifact>& artifacts) {
  const HoldStatistics statistics = holds(values);
  const double usual = static_cast<double>(values.size()) / static_cast<double>(statistics.changes);
  if (statistics.longest < kHeldSamples || static_cast<double>(statistics.longest) < 10.0 * usual ||
      usual > 3.0 || !has_fine_steps(values, statistics.changes))
    return;
  artifacts.push_back({.kind = "held_value",
                       .run = run,
                       .channel = column.name,
                       .description = "the same value " + std::to_string(statistics.longest) +
                                      " samples in a row: was the sensor or the logger stuck?",
                       .count = statistics.held_samples,
                       .first_time_s = log.time_s[statistics.longest_start]});
}

/// A channel with new values only at every k-th row: sampled slower than it is logged.
void find_slow(const std::string& run, const LogColumn& column, const std::vector<double>& values,
               std::vector<LogArtifact>& artifacts) {
  std::size_t moving = 0, changed = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] == 0.0) continue;
    ++moving;
    if (values[i] != values[i - 1]) ++changed;
  }
  if (moving < 50 || !has_fine_steps(values, changed) ||
      static_cast<double>(changed) > 0.6 * static_cast<double>(moving))
    return;
  const double every = static_cast<double>(moving) / static_cast<double>(std::max<std::size_t>(changed, 1));
  char text[96];
  std::snprintf(text, sizeof text,
                "a new value only at every %.1f-th row: the channel is slower than the log", every);
  artifacts.push_back({.kind = "slow_channel",
                       .run = run,
                       .channel = column.name,
                       .description = text,
                       .count = moving - changed});
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
  for (std::size_t i = 1; i < values.size(); ++i)
    values[i] -= turn * std::round((values[i] - values[i - 1]) / turn);
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
    result[i] = values[k] + share * (values[k + 1] - values[k]);
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

std::size_t fill_missing(const std::vector<double>& times, std::vector<double>& values) {
  std::vector<double> known_times, known_values;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) {
      known_times.push_back(times[i]);
      known_values.push_back(values[i]);
    }
  const std::size_t missing = values.size() - known_values.size();
  if (known_values.empty())
    values.clear();
  else if (missing > 0)
    values = interpolated(known_times, known_values, times);
  return missing;
}

std::vector<LogArtifact> find_artifacts(Trajectory& trajectory, const std::string& run) {
  std::vector<LogArtifact> artifacts;
  if (trajectory.size() < 3) return artifacts;
  find_gaps(trajectory, run, artifacts);
  for (const auto& column : log_columns()) {
    const std::vector<double>& values = column.channel(trajectory);
    const bool steady_by_nature = column.name == "time_s" || column.name == "payload_kg" ||
                                  column.name == "temperature_C" || column.name.rfind("command_", 0) == 0 ||
                                  !column.measured;
    if (values.empty() || steady_by_nature) continue;
    find_held(trajectory, run, column, values, artifacts);
    find_slow(run, column, values, artifacts);
  }
  return artifacts;
}

}  // namespace joulepath
