#include "diagnosis/checks/plausible.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/constant_payload.hpp"
#include "model/kinematics.hpp"
#include "model/log_columns.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

struct Bound {
  const char* column;
  double most;  ///< greatest plausible absolute value
  const char* hint;
};
constexpr Bound kColumnBounds[] = {
    {"motor_voltage_left_V", 1000, "millivolts?"},      {"motor_voltage_right_V", 1000, "millivolts?"},
    {"motor_current_left_A", 1000, "milliamperes?"},    {"motor_current_right_A", 1000, "milliamperes?"},
    {"motor_power_left_W", 1e5, "milliwatts?"},         {"motor_power_right_W", 1e5, "milliwatts?"},
    {"battery_voltage_V", 1000, "millivolts?"},         {"battery_current_A", 2000, "milliamperes?"},
    {"gyro_yaw_rate_rad_s", 30, "degrees per second?"}, {"payload_kg", 1e4, "grams?"},
};

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

void check_time(const Trajectory& log, Findings& findings) {
  const auto is_long = [](double before_s, double after_s) { return after_s - before_s > kLongestStep_s; };
  if (std::ranges::adjacent_find(log.time_s, is_long) == log.time_s.end()) return;
  std::vector<double> steps;
  for (std::size_t i = 1; i < log.size(); ++i) steps.push_back(log.time_s[i] - log.time_s[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (*middle > kLongestStep_s)
    findings.push_back({"time_s", "time_s with a sample every " + four_digits(*middle) + " s",
                        "at most " + four_digits(kLongestStep_s) + " s between samples",
                        "milliseconds, microseconds?"});
}

void check_wheels(const Trajectory& log, const Geometry& geometry, Findings& findings) {
  for (Side side : kSides) {
    const double most = greatest(log.wheel_speed_rad_s[side]);
    if (most * geometry.wheel_radius_m[side] <= kFastest_m_s) continue;
    const std::string column = std::string("wheel_speed_") + side_name(side) + "_rad_s";
    findings.push_back({column,
                        column + " up to " + four_digits(most) + " rad/s, " +
                            four_digits(most * geometry.wheel_radius_m[side]) + " m/s at this robot's wheel",
                        "at most " + four_digits(kFastest_m_s) + " m/s",
                        "degrees per second, rpm or encoder ticks?"});
  }
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
  if (std::max(body, wheels) < kMoving_m_s) return;
  if (body <= kOddRatio * wheels && wheels <= kOddRatio * body) return;
  findings.push_back({"linear_speed_m_s",
                      "a mean speed of " + four_digits(body) + " m/s where this robot's wheels turn for " +
                          four_digits(wheels) + " m/s",
                      "a log of the robot that the dataset names",
                      "is it another robot's log, or wheel speeds before the gear?"});
}

}  // namespace

std::vector<Implausible> implausible_channels(const Run& run, const Robot& robot) {
  const Trajectory& log = run.log;
  Findings findings;
  check_time(log, findings);
  check_wheels(log, robot.geometry, findings);
  for (const Bound& bound : kColumnBounds)
    if (const double most = greatest_of(bound.column, run); most > bound.most)
      findings.push_back({bound.column, std::string(bound.column) + " up to " + four_digits(most),
                          "at most " + four_digits(bound.most), bound.hint});
  check_robot(log, robot.geometry, findings);
  return findings;
}

}  // namespace joulepath
