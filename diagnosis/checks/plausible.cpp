#include "diagnosis/checks/plausible.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/checks/column_bounds.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/constant_payload.hpp"
#include "model/kinematics.hpp"
#include "model/log_columns.hpp"
#include "model/median.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

double greatest(const std::vector<double>& values) {
  double most = 0;
  for (double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// The greatest absolute value of a column; of the payload, that of a run without such a column.
double greatest_of(const std::string& column, const Run& run) {
  const std::vector<double>& values = find_log_column(column)->of(run.log);
  return values.empty() && column == "payload_kg" ? std::abs(constant_payload_kg(run)) : greatest(values);
}

using Findings = std::vector<Implausible>;

/// A clock in a smaller unit than seconds shows in its year, or in a wheel that needs minutes and many
/// samples to come to speed.
void check_slow_clock(const Run& run, Findings& findings) {
  const auto tell = [&](std::string found, std::string accepted) {
    findings.push_back({"time_s", std::move(found), std::move(accepted), kClockHint});
  };
  if (run.clock_origin_s > kLatestClock_s)
    return tell("a clock that begins at " + four_digits(run.clock_origin_s) + " s",
                "at most " + four_digits(kLatestClock_s) + " s, the year 2286 of an epoch clock");
  for (Side side : kSides) {
    const std::vector<double>& speed_rad_s = run.log.wheel_speed_rad_s[side];
    QuickestStart start;
    for (std::size_t i = 0; i < speed_rad_s.size(); ++i) start.add(run.log.time_s[i], speed_rad_s[i]);
    if (start.is_too_slow())
      return tell("a wheel that needs " + four_digits(start.duration_s()) + " s to come to " +
                      four_digits(greatest(speed_rad_s)) + " rad/s at its steepest",
                  "at most " + four_digits(kLongestStart_s) + " s");
  }
}

/// Zero where no step is longer than kLongestStep_s: the steps of a long log are then not copied.
double median_of_long_steps(const std::vector<double>& time_s) {
  const auto is_long = [](double before_s, double after_s) { return after_s - before_s > kLongestStep_s; };
  if (std::ranges::adjacent_find(time_s, is_long) == time_s.end()) return 0.0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return upper_median(std::move(steps));
}

void check_time(const Run& run, Findings& findings) {
  const std::vector<double>& time_s = run.log.time_s;
  if (time_s.size() < 2) return;
  const double length_s = time_s.back() - time_s.front();
  const double mean_s = length_s / static_cast<double>(time_s.size() - 1);
  const double median_s = median_of_long_steps(time_s);
  if (mean_s < kShortestPeriod_s)
    findings.push_back({"time_s",
                        "time_s with a sample every " + four_digits(mean_s) + " s: the run lasts " +
                            four_digits(length_s) + " s",
                        "at least " + four_digits(kShortestPeriod_s) + " s between samples", kClockHint});
  else if (median_s > kLongestStep_s)
    findings.push_back({"time_s", "time_s with a sample every " + four_digits(median_s) + " s",
                        "at most " + four_digits(kLongestStep_s) + " s between samples", kClockHint});
  else
    check_slow_clock(run, findings);
}

/// Compares the mean speed of the body as logged (or from the pose) with the speed computed from this robot's
/// wheels.
void check_robot(const Trajectory& log, const Geometry& geometry, Findings& findings) {
  const std::size_t n = log.size();
  if (log.linear_speed_m_s.size() != n || log.wheel_speed_rad_s.left.size() != n || n == 0) return;
  double body = 0, wheels = 0;
  for (std::size_t i = 0; i < n; ++i) {
    body += std::abs(log.linear_speed_m_s[i]) / static_cast<double>(n);
    wheels += std::abs(body_twist(geometry, Sided<double>{log.wheel_speed_rad_s.left[i],
                                                          log.wheel_speed_rad_s.right[i]})
                           .speed_m_s) /
              static_cast<double>(n);
  }
  if (!(std::max(body, wheels) >= kMoving_m_s)) return;  // or unknown in a part of the log
  if (body <= kOddRatio * wheels && wheels <= kOddRatio * body) return;
  findings.push_back({"linear_speed_m_s",
                      "a mean speed of " + four_digits(body) + " m/s where this robot's wheels turn for " +
                          four_digits(wheels) + " m/s",
                      "a log of the robot that the dataset names",
                      "is it another robot's log, or wheel speeds before the gear?"});
}

}  // namespace

std::vector<Implausible> implausible_clock(const Run& run) {
  Findings findings;
  check_time(run, findings);
  return findings;
}

std::vector<Implausible> implausible_channels(const Run& run, const Robot& robot) {
  const Trajectory& log = run.log;
  Findings findings;
  check_time(run, findings);
  for (const ColumnBound& bound : column_bounds(robot))
    if (const std::string column(bound.column); greatest_of(column, run) > bound.most)
      findings.push_back({column, column + " up to " + four_digits(greatest_of(column, run)),
                          "at most " + four_digits(bound.most), bound.hint});
  check_robot(log, robot.geometry, findings);
  return findings;
}

}  // namespace joulepath
