#include "extensions/onboard/monitor/log_excerpt.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/checks/data_checks.hpp"
#include "model/log_columns.hpp"

namespace joulepath {
namespace {

/// The checks know channels with a reading in every row: a gap holds the last reading, and a channel that
/// lacks most of its readings is none.
void fill_gaps(std::vector<double>& values) {
  const auto absent = std::ranges::count_if(values, [](double value) { return std::isnan(value); });
  if (2 * static_cast<std::size_t>(absent) >= values.size()) return values.clear();
  double last = *std::ranges::find_if(values, [](double value) { return !std::isnan(value); });
  for (double& value : values) last = value = std::isnan(value) ? last : value;
}

}  // namespace

void append_row(const MonitorRow& row, double payload_kg, Trajectory& log) {
  log.time_s.push_back(row.time_s);
  for (const Side side : kSides) {
    log.wheel_speed_rad_s[side].push_back(row.wheel_speed_rad_s[side]);
    log.motor_voltage_V[side].push_back(row.motor_voltage_V[side]);
    log.motor_current_A[side].push_back(row.motor_current_A[side]);
    log.motor_power_W[side].push_back(row.motor_power_W[side]);
  }
  log.battery_voltage_V.push_back(row.battery_voltage_V);
  log.battery_current_A.push_back(row.battery_current_A);
  log.heading_rad.push_back(row.heading_rad);
  log.payload_kg.push_back(payload_kg);
}

LogExcerpt::LogExcerpt(const Robot& robot) {
  dataset_.robot = robot;
  dataset_.runs.push_back({.name = "the log", .payload_known = true});
  append_row({}, 0.0, dataset_.runs.front().log);
  for (const LogColumn& column : log_columns())
    if (std::vector<double>& values = column.channel(dataset_.runs.front().log); !values.empty())
      values.reserve(kMostRows), values.clear();
}

void LogExcerpt::drop_first_half() {
  for (const LogColumn& column : log_columns())
    if (std::vector<double>& values = column.channel(dataset_.runs.front().log); !values.empty())
      values.erase(values.begin(), values.begin() + kMostRows / 2);
}

std::optional<Implausible> LogExcerpt::judged() const {
  Dataset excerpt = dataset_;
  Trajectory& log = excerpt.runs.front().log;
  if (log.size() == 0) return std::nullopt;
  for (const LogColumn& column : log_columns()) fill_gaps(column.channel(log));
  excerpt.runs.front().payload = {{log.time_s.front(), log.payload_kg.front()}};
  for (const DataCheck& check : check_data(excerpt, sort_runs(excerpt)))
    return Implausible{check.channel, check.kind + ", " + check.evidence,
                       "channels that agree with each other", "`check` of this log says more"};
  return std::nullopt;
}

std::optional<Implausible> LogExcerpt::add(const MonitorRow& row, double payload_kg) {
  Trajectory& log = dataset_.runs.front().log;
  append_row(row, payload_kg, log);
  if (log.size() < next_) return std::nullopt;
  std::optional<Implausible> found = judged();
  next_ = std::min(2 * log.size(), kMostRows);
  if (log.size() == kMostRows) drop_first_half();
  return found;
}

}  // namespace joulepath
