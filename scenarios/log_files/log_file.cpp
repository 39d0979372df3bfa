#include "scenarios/log_files/log_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scenarios/log_files/log_repair.hpp"

namespace joulepath {
namespace {

/// True if a column of a file is a channel of its run.
bool wanted(const std::string& header, const ColumnSources& sources) {
  const auto names = [&](const std::string& column) {
    const auto source = sources.find(column);
    if (source != sources.end() && source->second.is_absent) return false;
    const auto in_file = names_in_file(column, sources);
    return std::find(in_file.begin(), in_file.end(), header) != in_file.end();
  };
  for (const auto& column : log_columns())
    if (column.measured && names(column.name)) return true;
  return std::any_of(std::begin(kOrientationColumns), std::end(kOrientationColumns), names);
}

/// "12 % of the rows are empty"; without the number where it would be 0.
std::string share_text(std::size_t missing, std::size_t rows) {
  const std::size_t percent = (200 * missing + rows) / (2 * rows);
  return percent == 0 ? "empty cells" : std::to_string(percent) + " % of the rows are empty";
}

class LogFileReader {
 public:
  LogFileReader(CsvTable table, const ColumnSources& sources, const std::string& run)
      : sources_(sources), run_(run) {
    file_.table = std::move(table);
    if (file_.table.rows() < 2)
      throw ConfigError({{file_.table.file, 0, 0},
                         "",
                         std::to_string(file_.table.rows()) + (file_.table.rows() == 1 ? " row" : " rows"),
                         "at least 2 samples",
                         ""});
    count_uses();
    read_times();
    for (const auto& column : log_columns())
      if (column.measured && column.name != "time_s") read_channel(column.name);
    for (const char* name_of : kOrientationColumns) read_channel(name_of);
    if (used_orientation()) heading_from_orientation();
    for (const char* name_of : kOrientationColumns) file_.channels.erase(name_of);
    file_.table.columns = {};  // their values are in the channels
    file_.table.line_of_row = std::vector<int>();
  }

  LogFile take() { return std::move(file_); }

 private:
  std::vector<double>* raw(const std::string& column) {
    for (const auto& name : names_in_file(column, sources_))
      if (const auto at = std::ranges::find(file_.table.header, name); at != file_.table.header.end())
        return &file_.table.columns[static_cast<std::size_t>(at - file_.table.header.begin())];
    return nullptr;
  }

  /// Counts the channels that read each column, so that the last one can move it; a long log is then not in
  /// memory twice.
  void count_uses() {
    for (const auto& column : log_columns())
      if (column.measured) ++uses_[raw(column.name)];
    for (const char* name_of : kOrientationColumns) ++uses_[raw(name_of)];
  }

  std::vector<double> take(std::vector<double>& values) {
    return --uses_[&values] == 0 ? std::move(values) : values;
  }

  ColumnSource source(const std::string& column) const {
    const auto found = sources_.find(column);
    return found == sources_.end() ? ColumnSource{} : found->second;
  }

  [[noreturn]] void fail_time(std::size_t row, std::string found, std::string accepted,
                              std::string hint = {}) const {
    throw ConfigError({{file_.table.file, file_.table.line(row), 1},
                       names_in_file("time_s", sources_).front(),
                       std::move(found),
                       std::move(accepted),
                       std::move(hint)});
  }

  void read_times() {
    auto* values = raw("time_s");
    if (!values) {
      const std::string expected = names_in_file("time_s", sources_).front();
      const std::string near = nearest_word(expected, file_.table.header);
      throw ConfigError({{file_.table.file, 1, 1},
                         "",
                         "no column " + expected,
                         "a column with the time of each sample",
                         near.empty() ? "map the log's own name under columns: time_s: {from: ...}"
                                      : "map it under columns: time_s: {from: " + near + "}?"});
    }
    file_.times = take(*values);
    const ColumnSource mapping = source("time_s");
    for (std::size_t i = 0; i < file_.times.size(); ++i)
      if (!std::isfinite(file_.times[i])) fail_time(i, "an empty cell", "the time of every sample");
    if (mapping.wraps_at)
      if (const auto wraps = unwrap_counter(file_.times, *mapping.wraps_at))
        file_.artifacts.push_back(
            {"wrapped", run_, "time_s", "the clock restarts at 0 and was unwrapped", wraps, 0.0});
    for (double& time_s : file_.times) time_s = mapping.scale * time_s + mapping.offset;
    for (std::size_t i = 1; i < file_.times.size(); ++i)
      if (file_.times[i] <= file_.times[i - 1]) fail_backward(i, mapping);
  }

  [[noreturn]] void fail_backward(std::size_t i, const ColumnSource& mapping) const {
    char found[96];
    std::snprintf(found, sizeof found, "%.9g s after %.9g s", file_.times[i], file_.times[i - 1]);
    const bool wrapped = !mapping.wraps_at &&
                         file_.times[i - 1] - file_.times[i] > 0.5 * (file_.times[i - 1] - file_.times[0]) &&
                         file_.times[i] >= 0.0 && i > 2;
    fail_time(i, found, "times that increase strictly",
              wrapped ? "if the clock restarts at 0, set columns: time_s: {wraps_at: ...}" : "");
  }

  void read_channel(const std::string& name) {
    auto* values = raw(name);
    if (!values) return;
    const ColumnSource mapping = source(name);
    if (mapping.is_absent) return;
    std::vector<double> channel = take(*values);
    std::vector<bool> own(channel.size());
    std::transform(channel.begin(), channel.end(), own.begin(),
                   [](double value) { return std::isfinite(value); });
    const auto readings = std::ranges::count(own, true);
    const std::size_t missing =
        fill_missing(file_.times, channel, name == "payload_kg" ? Ends::held : Ends::unknown);
    if (missing > 0)
      file_.artifacts.push_back({"missing_values", run_, name,
                                 !channel.empty()
                                     ? share_text(missing, channel.size()) + ", filled by interpolation"
                                 : readings == 0 ? "the column is empty"
                                                 : "the column has one reading, and is left out",
                                 missing, 0.0});
    if (channel.empty()) return;
    if (mapping.wraps_at)
      if (const auto wraps = unwrap_counter(channel, *mapping.wraps_at))
        file_.artifacts.push_back(
            {"wrapped", run_, name, "the counter restarts at 0 and was unwrapped", wraps, 0.0});
    convert(channel, mapping);
    if (readings < std::ssize(own) || mapping.delay_s != 0.0)
      file_.holds[name] = holds_of_own(channel, own, mapping.delay_s);
    shift(channel, mapping);
    file_.channels[name] = std::move(channel);
  }

  void convert(std::vector<double>& channel, const ColumnSource& mapping) const {
    for (double& value : channel) value = mapping.scale * value + mapping.offset;
    if (mapping.derivative) channel = change_per_second(file_.times, channel);
  }

  /// A late channel at the times that it belongs to.
  void shift(std::vector<double>& channel, const ColumnSource& mapping) const {
    if (mapping.delay_s == 0.0) return;
    std::vector<double> shifted = file_.times;
    for (double& time_s : shifted) time_s -= mapping.delay_s;
    channel = interpolated(shifted, channel, file_.times);
  }

  [[nodiscard]] Holds holds_of_own(const std::vector<double>& channel, const std::vector<bool>& own,
                                   double delay_s) const {
    std::vector<double> times, readings;
    for (std::size_t i = 0; i < channel.size(); ++i)
      if (own[i]) times.push_back(file_.times[i] - delay_s), readings.push_back(channel[i]);
    return holds_of(times, readings);
  }

  [[nodiscard]] bool used_orientation() const {
    return !file_.channels.contains("heading_rad") && !source("heading_rad").is_absent &&
           file_.channels.contains("orientation_w") && file_.channels.contains("orientation_z");
  }

  /// Yaw of a quaternion with the two-argument arctangent; [P1, Eq. (37)] prints the one with one argument.
  void heading_from_orientation() {
    const auto channel = [&](const char* name) {
      const auto found = file_.channels.find(name);
      return found == file_.channels.end() ? nullptr : &found->second;
    };
    const auto *w_of = channel("orientation_w"), *x_of = channel("orientation_x"),
               *y_of = channel("orientation_y"), *z_of = channel("orientation_z");
    std::vector<double> heading_rad(file_.times.size());
    for (std::size_t i = 0; i < file_.times.size(); ++i) {
      const double w = (*w_of)[i], x = x_of ? (*x_of)[i] : 0.0, y = y_of ? (*y_of)[i] : 0.0, z = (*z_of)[i];
      const double norm = w * w + x * x + y * y + z * z;
      if (norm < 0.25 || norm > 4.0)
        throw ConfigError({{file_.table.file, file_.table.line(i), 1},
                           "orientation_w",
                           "a quaternion of length " + std::to_string(std::sqrt(norm)),
                           "a unit quaternion",
                           ""});
      heading_rad[i] = std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
    }
    unwrap_angle(heading_rad);
    convert(heading_rad, source("heading_rad"));
    shift(heading_rad, source("heading_rad"));
    file_.channels["heading_rad"] = std::move(heading_rad);
  }

  const ColumnSources& sources_;
  const std::string& run_;
  std::map<const std::vector<double>*, int> uses_{};
  LogFile file_{};
};

}  // namespace

std::vector<std::string> names_in_file(const std::string& column, const ColumnSources& sources) {
  const auto source = sources.find(column);
  return source == sources.end() || source->second.from.empty() ? std::vector<std::string>{column}
                                                                : source->second.from;
}

LogFile read_log_table(CsvTable table, const ColumnSources& sources, const std::string& run) {
  return LogFileReader(std::move(table), sources, run).take();
}

LogFile read_log_file(const LogFileName& name, const ColumnSources& sources, const std::string& run) {
  if (name.table) return read_log_table(*name.table, sources, run);
  return read_log_table(
      read_csv(
          name.file, [&](const std::string& header) { return wanted(header, sources); }, name.named_by),
      sources, run);
}

}  // namespace joulepath
