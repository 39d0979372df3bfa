#include "scenarios/log_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/document.hpp"

namespace joulepath {
namespace {

struct StreamColumn {
  const char* name;
  double& (*field)(MonitorRow&, Twist<double>&);
};

#define JOULEPATH_STREAM(column, member)                                          \
  StreamColumn {                                                                  \
    column, [](MonitorRow& row, Twist<double>&) -> double& { return row.member; } \
  }
const std::array kStreamColumns{
    JOULEPATH_STREAM("time_s", time_s),
    JOULEPATH_STREAM("wheel_speed_left_rad_s", wheel_speed_rad_s.left),
    JOULEPATH_STREAM("wheel_speed_right_rad_s", wheel_speed_rad_s.right),
    JOULEPATH_STREAM("motor_voltage_left_V", motor_voltage_V.left),
    JOULEPATH_STREAM("motor_voltage_right_V", motor_voltage_V.right),
    JOULEPATH_STREAM("motor_current_left_A", motor_current_A.left),
    JOULEPATH_STREAM("motor_current_right_A", motor_current_A.right),
    JOULEPATH_STREAM("motor_power_left_W", motor_power_W.left),
    JOULEPATH_STREAM("motor_power_right_W", motor_power_W.right),
    JOULEPATH_STREAM("battery_voltage_V", battery_voltage_V),
    JOULEPATH_STREAM("battery_current_A", battery_current_A),
    JOULEPATH_STREAM("heading_rad", heading_rad),
    JOULEPATH_STREAM("payload_kg", payload_kg),
    StreamColumn{"linear_speed_m_s",
                 [](MonitorRow&, Twist<double>& body) -> double& { return body.speed_m_s; }},
    StreamColumn{"angular_speed_rad_s",
                 [](MonitorRow&, Twist<double>& body) -> double& { return body.yaw_rate_rad_s; }},
};
#undef JOULEPATH_STREAM

std::string_view trimmed_cell(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"";
  const std::size_t from = text.find_first_not_of(kBlank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

/// Calls use(index, cell) for each cell of a line.
template <class Use>
void for_each_cell(std::string_view line, char separator, Use&& use) {
  for (std::size_t index = 0;; ++index) {
    const std::size_t end = line.find(separator);
    use(index, trimmed_cell(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

std::size_t stream_column(std::string_view name) {
  const auto* found = std::find_if(kStreamColumns.begin(), kStreamColumns.end(),
                                   [&](const StreamColumn& column) { return name == column.name; });
  return static_cast<std::size_t>(found - kStreamColumns.begin());
}

constexpr Twist<double> kNoTwist{kAbsent, kAbsent};

}  // namespace

std::optional<MonitorRow> LogLines::row(std::string_view line) {
  ++line_;
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  const std::string_view text = trimmed_cell(line);
  if (text.empty() || text.front() == '#') return std::nullopt;
  if (text.front() == '{') return json_row(text);
  if (column_.empty() && has_json_) return MonitorRow{};
  if (column_.empty()) {
    read_header(line);
    return std::nullopt;
  }
  return csv_row(line);
}

void LogLines::read_header(std::string_view line) {
  separator_ = ',';
  for (const char candidate : {';', '\t'})
    if (line.find(candidate) != std::string_view::npos) separator_ = candidate;
  for_each_cell(line, separator_,
                [&](std::size_t, std::string_view name) { column_.push_back(stream_column(name)); });
  const auto has = [&](const char* name) { return std::ranges::count(column_, stream_column(name)) > 0; };
  const bool has_wheels = has("wheel_speed_left_rad_s") && has("wheel_speed_right_rad_s");
  if (has("time_s") && (has_wheels || (has("linear_speed_m_s") && has("angular_speed_rad_s")))) return;
  throw ConfigError(
      {{file_, line_, 1},
       "",
       "a header without the columns of a log",
       "time_s with wheel_speed_left_rad_s and wheel_speed_right_rad_s, or with linear_speed_m_s "
       "and angular_speed_rad_s; or a JSON object per line with these keys",
       ""});
}

MonitorRow LogLines::csv_row(std::string_view line) const {
  MonitorRow row;
  Twist<double> body = kNoTwist;
  for_each_cell(line, separator_, [&](std::size_t index, std::string_view cell) {
    if (index >= column_.size() || column_[index] >= kStreamColumns.size()) return;
    kStreamColumns[column_[index]].field(row, body) = parse_number(cell).value_or(kAbsent);
  });
  return finished(row, body);
}

MonitorRow LogLines::json_row(std::string_view line) {
  MonitorRow row;
  Twist<double> body = kNoTwist;
  has_json_ = true;
  const auto json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object()) return row;
  for (const StreamColumn& column : kStreamColumns)
    if (const auto found = json.find(column.name); found != json.end() && found->is_number())
      column.field(row, body) = found->get<double>();
  return finished(row, body);
}

/// Wheel speeds of the body's, where a log has only those.
MonitorRow LogLines::finished(MonitorRow row, const Twist<double>& body) const {
  if (std::isnan(row.wheel_speed_rad_s.left + row.wheel_speed_rad_s.right))
    row.wheel_speed_rad_s = wheel_speeds_rad_s(geometry_, body.speed_m_s, body.yaw_rate_rad_s);
  return row;
}

MonitorRow monitor_row(const Trajectory& log, std::size_t k) {
  const auto at = [&](const std::vector<double>& values) { return k < values.size() ? values[k] : kAbsent; };
  const auto both = [&](const Sided<std::vector<double>>& values) {
    return Sided<double>{at(values.left), at(values.right)};
  };
  return {.time_s = at(log.time_s),
          .wheel_speed_rad_s = both(log.wheel_speed_rad_s),
          .motor_voltage_V = both(log.motor_voltage_V),
          .motor_current_A = both(log.motor_current_A),
          .motor_power_W = both(log.motor_power_W),
          .battery_voltage_V = at(log.battery_voltage_V),
          .battery_current_A = at(log.battery_current_A),
          .heading_rad = at(log.heading_rad),
          .payload_kg = at(log.payload_kg)};
}

}  // namespace joulepath
