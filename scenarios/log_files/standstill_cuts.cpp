#include "scenarios/log_files/standstill_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "scenarios/log_files/clock_jumps.hpp"
// Design: docs/decisions/0601-logs.md
namespace joulepath {
namespace {

constexpr double kLongLog_s = 180.0;      ///< a shorter log counts as one manoeuvre of a test day
constexpr double kShortestPart_s = 20.0;  ///< of the parts of a cut log
constexpr double kMostParts = 200.0;      ///< approximate bound for all logs together
constexpr double kShortestStop_s = 0.8;   ///< both parts need a margin for smoothing
constexpr double kStill_rad_s = 0.1;      ///< a wheel stands below this speed plus its noise

double duration_s(const Run& run) {
  return run.log.size() < 2 ? 0.0 : run.log.time_s.back() - run.log.time_s.front();
}

bool is_cut(const Run& run) {
  return duration_s(run) > kLongLog_s && !run.predicted && !run.measured_energy_J && !run.battery_energy_Wh &&
         run.log.wheel_speed_rad_s.left.size() == run.log.size() &&
         run.log.wheel_speed_rad_s.right.size() == run.log.size();
}

/// The cut in a stop: where the payload changes, else in its middle.
std::size_t cut_of_stop(const Trajectory& log, std::size_t begin, std::size_t end) {
  if (log.payload_kg.size() == log.size())
    for (std::size_t i = end; i > begin; --i)
      if (log.payload_kg[i] != log.payload_kg[i - 1]) return i;
  return begin + (end - begin) / 2;
}

/// Cuts inside the stops, at least `part_s` apart and from both ends.
std::vector<std::size_t> cuts_of(const Trajectory& log, double part_s) {
  const auto still = [&](std::size_t i) {
    return std::max(std::abs(log.wheel_speed_rad_s.left[i]), std::abs(log.wheel_speed_rad_s.right[i])) <
           kStill_rad_s;
  };
  std::vector<std::size_t> bounds{0};
  for (std::size_t begin = 0; begin < log.size(); ++begin) {
    if (!still(begin)) continue;
    std::size_t end = begin;
    while (end + 1 < log.size() && still(end + 1)) ++end;
    const std::size_t cut = cut_of_stop(log, begin, end);
    if (log.time_s[end] - log.time_s[begin] >= kShortestStop_s &&
        log.time_s[cut] - log.time_s[bounds.back()] >= part_s &&
        log.time_s.back() - log.time_s[cut] >= part_s)
      bounds.push_back(cut);
    begin = end;
  }
  bounds.push_back(log.size());
  return bounds;
}

}  // namespace

std::vector<Run> cut_at_standstill(std::vector<Run> runs, std::vector<LogArtifact>& artifacts) {
  double all_s = 0;
  for (const Run& run : runs) all_s += duration_s(run);
  const double part_s = std::max(kShortestPart_s, all_s / kMostParts);
  std::vector<Run> parts;
  for (Run& run : runs) {
    const std::vector<std::size_t> bounds =
        is_cut(run) ? cuts_of(run.log, part_s) : std::vector<std::size_t>{0, run.log.size()};
    if (bounds.size() == 2) {
      parts.push_back(std::move(run));
      continue;
    }
    artifacts.push_back({"cut", run.name, "",
                         "a long log, cut at standstill into " + std::to_string(bounds.size() - 1) + " runs",
                         bounds.size() - 1, run.log.time_s.front()});
    std::ranges::move(stretches_between(std::move(run), bounds), std::back_inserter(parts));
  }
  return parts;
}

}  // namespace joulepath
