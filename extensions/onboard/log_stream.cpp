#include "extensions/onboard/log_stream.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/text/document.hpp"
#include "scenarios/text/next_line.hpp"
#include "scenarios/text/shallow_json.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kMostRowBytes = 1u << 20;

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

double at(const std::vector<double>& values, std::size_t k) {
  return k < values.size() ? values[k] : kAbsent;
}

}  // namespace

std::optional<MonitorRow> LogLines::row(std::string_view line) {
  ++line_;
  if (line.size() > kMostRowBytes)
    throw ConfigError({{file_, line_, 1}, "", "a line of more than 1 MiB", "a row of a log per line", ""});
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

void LogLines::follow(std::istream& stream, const std::function<void(const MonitorRow&)>& use) {
  for (std::string line; next_line(stream, line, kMostRowBytes);)
    if (const auto found = row(line)) use(*found);
}

void LogLines::read_header(std::string_view line) {
  separator_ = ',';
  for (const char candidate : {';', '\t'})
    if (line.find(candidate) != std::string_view::npos) separator_ = candidate;
  for_each_cell(line, separator_, [&](std::size_t, std::string_view name) {
    const LogColumn* column = find_log_column(std::string(name));
    if (column && std::ranges::count(column_, column) > 0)
      throw ConfigError({{file_, line_, 1}, column->name, "a duplicate column", "each column once", ""});
    column_.push_back(column);
  });
  const auto has = [&](const char* name) { return std::ranges::count(column_, find_log_column(name)) > 0; };
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

MonitorRow LogLines::csv_row(std::string_view line) {
  clear();
  for_each_cell(line, separator_, [&](std::size_t index, std::string_view cell) {
    if (index < column_.size() && column_[index])
      column_[index]->channel(row_).assign(1, parse_number(cell).value_or(kAbsent));
  });
  return finished();
}

MonitorRow LogLines::json_row(std::string_view line) {
  has_json_ = true;
  clear();
  std::set<std::string> keys;
  bool doubled = false;
  const auto note_key = [&](int depth, nlohmann::json::parse_event_t event, const nlohmann::json& value) {
    if (event == nlohmann::json::parse_event_t::key && depth == 1)
      doubled |= !keys.insert(value.get<std::string>()).second;
    return true;
  };
  const auto json = shallow_json(line, note_key);
  if (!json.is_object() || doubled) return {};
  for (const LogColumn& column : log_columns())
    if (const auto found = json.find(column.name); found != json.end() && found->is_number())
      column.channel(row_).assign(1, found->get<double>());
  return finished();
}

void LogLines::clear() {
  for (const LogColumn& column : log_columns()) column.channel(row_).clear();
}

/// The row, with wheel speeds of the body's, where a log has only those.
MonitorRow LogLines::finished() const {
  MonitorRow row = monitor_row(row_, 0);
  if (std::isnan(row.wheel_speed_rad_s.left + row.wheel_speed_rad_s.right))
    row.wheel_speed_rad_s =
        wheel_speeds_rad_s(geometry_, at(row_.linear_speed_m_s, 0), at(row_.angular_speed_rad_s, 0));
  return row;
}

MonitorRow monitor_row(const Trajectory& log, std::size_t k) {
  const auto both = [&](const Sided<std::vector<double>>& values) {
    return Sided<double>{at(values.left, k), at(values.right, k)};
  };
  return {.time_s = at(log.time_s, k),
          .wheel_speed_rad_s = both(log.wheel_speed_rad_s),
          .motor_voltage_V = both(log.motor_voltage_V),
          .motor_current_A = both(log.motor_current_A),
          .motor_power_W = both(log.motor_power_W),
          .battery_voltage_V = at(log.battery_voltage_V, k),
          .battery_current_A = at(log.battery_current_A, k),
          .heading_rad = at(log.heading_rad, k),
          .payload_kg = at(log.payload_kg, k)};
}

}  // namespace joulepath
