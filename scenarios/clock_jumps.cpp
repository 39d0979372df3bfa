#include "scenarios/clock_jumps.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "scenarios/log_columns.hpp"
// Design: docs/decisions/0150-input-is-bounded.md

namespace joulepath {
namespace {

constexpr double kShortestJump_s = 60.0;
constexpr double kShortestJumpInSteps = 100.0;
/// A greater clock value is an error of the clock, so its time of day is unknown.
constexpr double kKnownTimeOfDay_s = 1e6;

/// First samples of the stretches between jumps, and the end.
std::vector<std::size_t> stretch_bounds(const std::vector<double>& time_s) {
  std::vector<double> steps(time_s.size() - 1);
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) steps[i] = time_s[i + 1] - time_s[i];
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double least_s = std::max(kShortestJump_s, kShortestJumpInSteps * *middle);
  std::vector<std::size_t> bounds{0};
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i] > least_s) bounds.push_back(i + 1);
  bounds.push_back(time_s.size());
  return bounds;
}

Trajectory samples_between(const Trajectory& log, std::size_t first, std::size_t end) {
  Trajectory part;
  for (const LogColumn& column : log_columns()) {
    const std::vector<double>& all = column.of(log);
    if (all.empty()) continue;
    column.channel(part).assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                                all.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return part;
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
  const Trajectory log = std::exchange(run.log, {});  // the rest is copied into each stretch
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    if (bounds[k + 1] - bounds[k] < 2) continue;
    stretches.push_back(run);
    stretches.back().log = samples_between(log, bounds[k], bounds[k + 1]);
    if (k > 0) begin_anew(stretches.back(), log.time_s.front(), stretches.size());
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
