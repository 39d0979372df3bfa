#include "scenarios/log_files/partial_channels.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "model/log_columns.hpp"
#include "model/printable.hpp"
#include "scenarios/log_files/clock_jumps.hpp"

namespace joulepath {
namespace {

constexpr double kShortestStretch_s = 2.0;  ///< of one manoeuvre

bool is_known(double value) { return !std::isnan(value); }

/// First sample in which a partial channel is known, and the one after its last.
std::pair<std::size_t, std::size_t> known_samples(const std::vector<double>& channel) {
  const auto first = std::ranges::find_if(channel, is_known);
  const auto last = std::find_if(channel.rbegin(), channel.rend(), is_known);
  return {static_cast<std::size_t>(first - channel.begin()), static_cast<std::size_t>(channel.rend() - last)};
}

/// The columns that are known in a part of the log alone, with that part.
void tell_partial(const Trajectory& log, const std::string& run, const std::string& consequence,
                  std::vector<LogArtifact>& artifacts) {
  for (const LogColumn& column : log_columns()) {
    const std::vector<double>& channel = column.of(log);
    if (!is_partial(channel)) continue;
    const auto [first, end] = known_samples(channel);
    artifacts.push_back({"partial_channel", run, column.name,
                         "known from " + four_digits(log.time_s[first]) + " s to " +
                             four_digits(log.time_s[end - 1]) + " s of a log from " +
                             four_digits(log.time_s.front()) + " s to " + four_digits(log.time_s.back()) +
                             " s; " + consequence,
                         end - first, log.time_s[first]});
  }
}

/// First samples of the stretches in which the same channels are known, and the end.
std::vector<std::size_t> bounds_of(const Trajectory& log) {
  std::set<std::size_t> bounds{0, log.size()};
  for (const LogColumn& column : log_columns())
    if (const std::vector<double>& channel = column.of(log); is_partial(channel)) {
      const auto [first, end] = known_samples(channel);
      bounds.insert({first, end});
    }
  return {bounds.begin(), bounds.end()};
}

/// The samples in which every channel is known that misses less than a fiftieth of the log, and less than a
/// manoeuvre, at its ends: channels of one log rarely begin with the same sample.
std::pair<std::size_t, std::size_t> nearly_all(const Trajectory& log) {
  constexpr double kShortEnds = 0.02;  // of the log
  const double most_s = std::min(kShortestStretch_s, kShortEnds * (log.time_s.back() - log.time_s.front()));
  std::pair<std::size_t, std::size_t> samples{0, log.size()};
  for (const LogColumn& column : log_columns())
    if (const std::vector<double>& channel = column.of(log); is_partial(channel)) {
      const auto [first, end] = known_samples(channel);
      if (first >= end) continue;
      const double missing_s =
          log.time_s[first] - log.time_s.front() + log.time_s.back() - log.time_s[end - 1];
      if (missing_s < most_s) samples = {std::max(samples.first, first), std::min(samples.second, end)};
    }
  return samples;
}

/// Cuts the log to them, and says so.
void cut_short_ends(Trajectory& log, const std::string& run, std::vector<LogArtifact>& artifacts) {
  if (log.size() < 2) return;
  const auto [first, end] = nearly_all(log);
  if (end - first == log.size()) return;
  artifacts.push_back({"cut", run, "",
                       four_digits(log.time_s[first] - log.time_s.front()) + " s at the beginning and " +
                           four_digits(log.time_s.back() - log.time_s[end - 1]) +
                           " s at the end are left out: channels begin later or end earlier",
                       log.size() - (end - first), log.time_s.front()});
  const auto keep = [first = first, end = end](std::vector<double>& values) {
    if (values.empty()) return;
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first));
  };
  for (const LogColumn& column : log_columns()) keep(column.channel(log));
}

/// Whether no value belongs to the whole of the run, and a stretch is long enough to stay.
bool may_be_cut(const Run& run, const std::vector<std::size_t>& bounds) {
  if (run.predicted || run.measured_energy_J || run.battery_energy_Wh) return false;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k)
    if (run.log.time_s[bounds[k + 1] - 1] - run.log.time_s[bounds[k]] >= kShortestStretch_s) return true;
  return false;
}

}  // namespace

bool is_partial(const std::vector<double>& channel) {
  return !channel.empty() && (std::isnan(channel.front()) || std::isnan(channel.back()));
}

void drop_partial_channels(Trajectory& log, const std::string& run, std::vector<LogArtifact>& artifacts) {
  cut_short_ends(log, run, artifacts);
  tell_partial(log, run, "left out, to keep the whole log", artifacts);
  for (const LogColumn& column : log_columns())
    if (std::vector<double>& channel = column.channel(log); is_partial(channel))
      channel = std::vector<double>();
}

std::vector<Run> split_at_partial_channels(Run run, std::vector<LogArtifact>& artifacts) {
  cut_short_ends(run.log, run.name, artifacts);
  std::vector<std::size_t> bounds = bounds_of(run.log);
  if (bounds.size() > 2 && !may_be_cut(run, bounds)) {
    drop_partial_channels(run.log, run.name, artifacts);
    bounds.clear();
  }
  std::vector<Run> kept;
  if (bounds.size() <= 2) {
    kept.push_back(std::move(run));
    return kept;
  }
  tell_partial(run.log, run.name, "a separate run begins and ends there", artifacts);
  std::vector<Run> stretches = stretches_between(std::move(run), bounds);
  for (Run& stretch : stretches) {
    Trajectory& log = stretch.log;
    for (const LogColumn& column : log_columns())
      if (std::vector<double>& channel = column.channel(log); is_partial(channel)) channel.clear();
    const double length_s = log.time_s.back() - log.time_s.front();
    if (length_s < kShortestStretch_s)
      artifacts.push_back({"cut", stretch.name, "",
                           "a stretch of " + four_digits(length_s) +
                               " s in which other channels are known than in the rest is left out",
                           log.size(), log.time_s.front()});
    else
      kept.push_back(std::move(stretch));
  }
  return kept;
}

}  // namespace joulepath
