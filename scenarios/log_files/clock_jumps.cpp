#include "scenarios/log_files/clock_jumps.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <utility>

#include "diagnosis/values/constant_payload.hpp"
#include "model/median.hpp"
#include "scenarios/log_files/log_columns.hpp"
// Design: docs/decisions/0601-logs.md

namespace joulepath {
namespace {

constexpr double kShortestJump_s = 60.0;
constexpr double kShortestJumpInSteps = 100.0;
/// A greater clock value is an error of the clock, so its time of day is unknown.
constexpr double kKnownTimeOfDay_s = 1e6;

/// First samples of the stretches between jumps, and the end.
std::vector<std::size_t> stretch_bounds(const std::vector<double>& time_s) {
  const auto is_long = [](double before_s, double after_s) { return after_s - before_s > kShortestJump_s; };
  if (std::ranges::adjacent_find(time_s, is_long) == time_s.end()) return {0, time_s.size()};
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) steps[i] = time_s[i + 1] - time_s[i];
  const double least_s = std::max(kShortestJump_s, kShortestJumpInSteps * upper_median(std::move(steps)));
  std::vector<std::size_t> bounds{0};
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i)
    if (time_s[i + 1] - time_s[i] > least_s) bounds.push_back(i + 1);
  bounds.push_back(time_s.size());
  return bounds;
}

/// Samples from a first one to the one before an end.
struct Stretch {
  std::size_t first{};
  std::size_t end{};
};

/// The same number to the last bit (0 and -0 differ).
bool is_constant(const std::vector<double>& values) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return std::ranges::adjacent_find(values, std::not_equal_to<>(), bits) == values.end();
}

/// A log in parts. It gives up its columns one by one, so that a long log is in memory once; the columns of
/// one value, which need no source, are made last.
std::vector<Trajectory> parts_of(Trajectory log, const std::vector<Stretch>& stretches) {
  std::vector<Trajectory> parts(stretches.size());
  std::vector<std::pair<const LogColumn*, double>> constants;
  for (const LogColumn& column : log_columns()) {
    std::vector<double>& values = column.channel(log);
    if (values.empty() || !is_constant(values)) continue;
    constants.emplace_back(&column, values.front());
    values = std::vector<double>();
  }
  for (const LogColumn& column : log_columns()) {
    std::vector<double>& values = column.channel(log);
    for (std::size_t k = 0; k < parts.size() && !values.empty(); ++k)
      column.channel(parts[k]).assign(values.begin() + static_cast<std::ptrdiff_t>(stretches[k].first),
                                      values.begin() + static_cast<std::ptrdiff_t>(stretches[k].end));
    values = std::vector<double>();
  }
  for (const auto& [column, value] : constants)
    for (std::size_t k = 0; k < parts.size(); ++k)
      column->channel(parts[k]).assign(stretches[k].end - stretches[k].first, value);
  return parts;
}

LogArtifact jump_before(const Run& run, std::size_t sample) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the clock jumps by %.4g s: the log is cut there, and the rest is a separate run",
                run.log.time_s[sample] - run.log.time_s[sample - 1]);
  return {"cut", run.name, "time_s", text, 1, run.log.time_s[sample - 1]};
}

/// Changes a later stretch: its clock begins at 0, its payload is that of the log.
void begin_anew(Run& later, double log_begin_s, std::size_t number) {
  later.name += " (part " + std::to_string(number) + ")";
  const double begin_s = later.log.time_s.front();
  for (double& time_s : later.log.time_s) time_s -= begin_s;
  if (begin_s - log_begin_s > kKnownTimeOfDay_s) later.start_time_s.reset();
  if (later.start_time_s) *later.start_time_s += begin_s;
  if (later.log.payload_kg.empty()) {
    later.payload = {{later.log.time_s.front(), constant_payload_kg(later)}};
    return;
  }
  later.payload.clear();
  for (std::size_t i = 0; i < later.log.payload_kg.size(); ++i)
    if (i == 0 || later.log.payload_kg[i] != later.log.payload_kg[i - 1])
      later.payload.push_back({later.log.time_s[i], later.log.payload_kg[i]});
}

}  // namespace

std::vector<Run> stretches_between(Run run, const std::vector<std::size_t>& bounds) {
  std::vector<Run> stretches;
  if (bounds.size() == 2) {
    stretches.push_back(std::move(run));
    return stretches;
  }
  std::vector<Stretch> long_enough;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k)
    if (bounds[k + 1] - bounds[k] >= 2) long_enough.push_back({bounds[k], bounds[k + 1]});
  const double begin_s = run.log.time_s.front();
  std::vector<Trajectory> parts = parts_of(std::exchange(run.log, {}), long_enough);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    stretches.push_back(run);  // what is left is copied into each stretch
    stretches.back().log = std::move(parts[k]);
    if (long_enough[k].first > 0) begin_anew(stretches.back(), begin_s, k + 1);
  }
  return stretches;
}

std::vector<Run> split_at_clock_jumps(Run run, std::vector<LogArtifact>& artifacts) {
  const bool has_steps = run.log.size() > 2;
  const auto bounds =
      has_steps ? stretch_bounds(run.log.time_s) : std::vector<std::size_t>{0, run.log.size()};
  for (std::size_t k = 1; k + 1 < bounds.size(); ++k) artifacts.push_back(jump_before(run, bounds[k]));
  return stretches_between(std::move(run), bounds);
}

}  // namespace joulepath
