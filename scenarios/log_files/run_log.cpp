#include "scenarios/log_files/run_log.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "model/kinematics.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/log_files/log_file.hpp"
#include "scenarios/log_files/log_repair.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/partial_channels.hpp"
// Design: docs/decisions/0601-logs.md

namespace joulepath {
namespace {

constexpr double kEpochClock_s = 1e6;  // a clock with a later start does not count from the start of the run

bool is_orientation(const std::string& name) {
  return std::any_of(std::begin(kOrientationColumns), std::end(kOrientationColumns),
                     [&](const char* q) { return name == q; });
}

/// Sets of channels of which each gives the motion.
const std::vector<std::string> kMotions[] = {{"wheel_speed_left_rad_s", "wheel_speed_right_rad_s"},
                                             {"linear_speed_m_s", "angular_speed_rad_s"},
                                             {"position_x_m", "position_y_m", "heading_rad"}};

/// A channel of one of a run's files.
struct FileChannel {
  std::size_t file{};
  std::string name{};
};

/// The channels of the first set that is there, else any of the motion.
std::vector<FileChannel> channels_of_motion(const std::vector<LogFile>& files) {
  std::vector<FileChannel> any;
  for (const std::vector<std::string>& motion : kMotions) {
    std::vector<FileChannel> set;
    for (const std::string& name : motion)
      for (std::size_t f = 0; f < files.size(); ++f)
        if (files[f].channels.contains(name)) {
          set.push_back({f, name});
          break;
        }
    if (set.size() == motion.size()) return set;
    any.insert(any.end(), set.begin(), set.end());
  }
  return any;
}

/// The time in which a channel is known.
KnownTime known_time(const std::vector<LogFile>& files, const FileChannel& channel) {
  const LogFile& file = files[channel.file];
  KnownTime known(file.times);
  const std::vector<double>& values = file.channels.at(channel.name);
  const auto is_known = [](double value) { return !std::isnan(value); };
  const auto first = std::ranges::find_if(values, is_known) - values.begin();
  const auto end = std::find_if(values.rbegin(), values.rend(), is_known).base() - values.begin();
  if (first > 0 && first < end) known.begin_s = file.times[static_cast<std::size_t>(first)];
  if (first < end && end < std::ssize(values)) known.end_s = file.times[static_cast<std::size_t>(end - 1)];
  return known;
}

/// The file whose times the log gets: the first, unless it misses a part of the motion.
std::size_t base_of(const std::vector<LogFile>& files, const std::vector<FileChannel>& motion) {
  if (motion.empty()) return 0;
  std::size_t first = files.size();
  for (const FileChannel& channel : motion) first = std::min(first, channel.file);
  const KnownTime base(files.front().times);
  const bool whole = base.covers(files[first].times.front()) && base.covers(files[first].times.back());
  return whole ? 0 : first;
}

/// Rows of the base, from and to, in which the motion is known.
std::pair<long, long> rows_with_motion(const std::vector<LogFile>& files, std::size_t base_file,
                                       const std::vector<FileChannel>& motion) {
  const std::vector<double>& base = files[base_file].times;
  double begin_s = base.front(), end_s = base.back();
  for (const FileChannel& channel : motion) {
    const KnownTime known = known_time(files, channel);
    begin_s = std::max(begin_s, known.begin_s), end_s = std::min(end_s, known.end_s);
  }
  const auto first = std::lower_bound(base.begin(), base.end(), begin_s),
             last = std::upper_bound(base.begin(), base.end(), end_s);
  return {first - base.begin(), std::max(first, last) - base.begin()};
}

/// A file without a time in common with the log belongs to another run, or to another clock.
void refuse_apart(const std::vector<LogFile>& files, std::size_t base_file,
                  const std::pair<long, long>& rows) {
  const std::vector<double>& base = files[base_file].times;
  for (std::size_t f = 0; f < files.size(); ++f) {
    const KnownTime own(files[f].times);
    long common = 0;
    for (long k = rows.first; k < rows.second && common < 2; ++k)
      common += own.covers(base[static_cast<std::size_t>(k)]) ? 1 : 0;
    if (common < 2)
      throw ConfigError(
          {{files[f == 0 ? files.size() - 1 : f].table.file, 0, 0},
           "time_s",
           "times that do not overlap with those of " + files[f == 0 ? 0 : base_file].table.file,
           "files of one run on one clock",
           "map time_s so that all files use the same clock"});
  }
}

void tell_cut(const std::vector<double>& base_s, const std::pair<long, long>& rows, RunLog& log,
              const std::string& run) {
  const auto count = static_cast<long>(base_s.size()) - (rows.second - rows.first);
  if (count == 0) return;
  const double before_s = base_s[static_cast<std::size_t>(rows.first)] - base_s.front(),
               after_s = base_s.back() - base_s[static_cast<std::size_t>(rows.second - 1)];
  log.artifacts.push_back({"cut", run, "",
                           four_digits(before_s) + " s at the beginning and " + four_digits(after_s) +
                               " s at the end are left out: the motion is not known there",
                           static_cast<std::size_t>(count), base_s.front()});
}

/// Takes the channels of all files to the times of one. Outside of its file's own time a channel is NaN; a
/// payload holds. Files give up their columns one by one: a long log is in memory once. The holds are those
/// of channels that are interpolated.
HoldsOfChannel merge(std::vector<LogFile>& files, RunLog& log, const std::string& run) {
  HoldsOfChannel holds;
  const std::vector<FileChannel> motion = channels_of_motion(files);
  const std::size_t base = base_of(files, motion);
  const std::pair<long, long> rows = rows_with_motion(files, base, motion);
  refuse_apart(files, base, rows);
  tell_cut(files[base].times, rows, log, run);
  const auto taken = [&](std::vector<double>& values) {
    values.erase(values.begin() + rows.second, values.end());
    values.erase(values.begin(), values.begin() + rows.first);
    return std::move(values);
  };
  const std::vector<double>& times = log.trajectory.time_s = taken(files[base].times);
  for (std::size_t f = 0; f < files.size(); ++f) {
    LogFile& file = files[f];
    for (auto& [name, values] : file.channels) {
      const LogColumn* column = find_log_column(name);
      if (!column || !column->channel(log.trajectory).empty()) continue;
      if (const auto of_readings = file.holds.find(name); of_readings != file.holds.end())
        holds[name] = std::move(of_readings->second);
      else if (f != base)
        holds[name] = holds_of(file.times, values);
      std::vector<double>& channel = column->channel(log.trajectory);
      if (f == base) {
        channel = taken(values);
        continue;
      }
      if (name == "heading_rad") unwrap_angle(values);
      channel = interpolated(file.times, values, times);
      values = std::vector<double>();  // `= {}` would keep the memory
      const KnownTime own(file.times);
      for (std::size_t k = 0; k < times.size() && name != "payload_kg"; ++k)
        if (!own.covers(times[k])) channel[k] = std::numeric_limits<double>::quiet_NaN();
    }
    file.times = std::vector<double>();
    file.channels.clear();
  }
  if (files.size() > 1)
    log.artifacts.push_back({"resampled", run, "",
                             "several files or topics, interpolated linearly to the times of " +
                                 (base == 0 ? "the first" : files[base].table.file),
                             files.size() - 1, times.front()});
  return holds;
}

/// The columns that are not those of the format, and not mapped to one.
std::vector<std::string> ignored_columns(const std::vector<std::string>& header,
                                         const ColumnSources& sources) {
  std::vector<std::string> ignored;
  std::ranges::copy_if(header, std::back_inserter(ignored), [&](const std::string& name) {
    return !find_log_column(name) && !is_orientation(name) &&
           std::ranges::none_of(
               sources, [&](const auto& column) { return std::ranges::count(column.second.from, name) > 0; });
  });
  return ignored;
}

void note_ignored(const std::vector<std::string>& ignored, RunLog& log, const std::string& run) {
  if (ignored.empty()) return;
  const auto text = [](const std::string& name) { return name.empty() ? "(no name)" : name; };
  log.artifacts.push_back({"ignored_columns", run, "", text_of_list(ignored, text), ignored.size(), 0.0});
}

/// Columns of the format that a run may have and does not have, save those declared absent.
std::vector<std::string> missing_columns(const Trajectory& log, const ColumnSources& sources) {
  std::vector<std::string> missing;
  for (const LogColumn& column : log_columns()) {
    const auto source = sources.find(column.name);
    const bool declared = source != sources.end() && source->second.is_absent;
    if (column.measured && !declared && column.of(log).empty()) missing.push_back(column.name);
  }
  return missing;
}

/// A name that differs a little from a column that the run lacks is a slip or another unit: without it, other
/// channels would stand in for the column.
void refuse_mistyped(const std::vector<std::string>& ignored, const std::vector<std::string>& missing,
                     const std::string& file) {
  constexpr std::size_t kLongestUnit = 6;  // "_rad_s"; "wheel" alone means no column
  for (const std::string& name : ignored) {
    const std::string near = nearest_word(name, missing, 5);
    if (near.empty() || near.size() > name.size() + kLongestUnit) continue;
    throw ConfigError({{file, 1, 1},
                       name,
                       "an unknown column",
                       "the columns of the run log format",
                       "did you mean " + near + "? `columns:` maps other names and units; `" + near +
                           ": {absent: true}` states that it was not measured"});
  }
}

/// `names`: of the columns, for hints. Those of a bag are sources already.
void check_mapped_columns_found(const std::vector<LogFile>& files, const ColumnSources& sources,
                                std::vector<std::string> names) {
  for (const auto& [column, source] : sources) {
    if (source.from.empty() || source.is_absent) continue;
    const std::vector<std::string>& from = source.from;  // clang 14 captures no structured binding
    const bool found = std::ranges::any_of(files, [&from](const LogFile& file) {
      return std::ranges::find_first_of(file.table.header, from) != file.table.header.end();
    });
    if (found) continue;
    for (const auto& [other, taken] : sources)  // a source of another column is no hint
      for (const std::string& name : taken.from) std::erase(names, name);
    const std::string near = nearest_word(source.from.front(), names);
    throw ConfigError({source.mark, "columns." + column + ".from", source.from.front(),
                       "a column of " + files.front().table.file,
                       near.empty() ? "" : "did you mean " + near + "?"});
  }
}

/// The other wheel's speed could only come from channels that contradict the measured one.
void refuse_one_wheel(const Trajectory& log, const std::string& file) {
  const auto& [left, right] = log.wheel_speed_rad_s;
  if (left.empty() == right.empty()) return;
  const std::string names[] = {"wheel_speed_left_rad_s", "wheel_speed_right_rad_s"};
  const std::string &there = names[left.empty() ? 1 : 0], &lacking = names[left.empty() ? 0 : 1];
  throw ConfigError(
      {{file, 1, 1},
       "",
       there + " without " + lacking,
       "the speeds of both wheels, or of none",
       "map " + lacking + " under columns:, or leave the other out with `" + there + ": {absent: true}`"});
}

void refuse_no_motion(const Trajectory& log, const std::string& file) {
  if (log.wheel_speed_rad_s.left.empty())
    throw ConfigError({{file, 1, 1},
                       "",
                       "no motion",
                       "wheel_speed_left_rad_s and wheel_speed_right_rad_s, or linear_speed_m_s and "
                       "angular_speed_rad_s, or a pose",
                       "map the log's own names under columns:"});
}

/// Body speeds that are not logged, from the pose's differences.
void derive_body_speeds(Trajectory& log, const std::string& run, std::vector<LogArtifact>& artifacts) {
  if (log.position_x_m.empty() || log.position_y_m.empty() || log.heading_rad.empty()) return;
  const std::size_t n = log.size();
  const auto tell = [&](const char* column) {
    artifacts.push_back({"derived", run, column, "from the pose's differences", n, 0.0});
  };
  std::vector<double> heading = log.heading_rad;
  unwrap_angle(heading);
  if (log.linear_speed_m_s.empty()) {
    const auto vx = change_per_second(log.time_s, log.position_x_m),
               vy = change_per_second(log.time_s, log.position_y_m);
    log.linear_speed_m_s.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double middle = i == 0 ? heading[0] : 0.5 * (heading[i] + heading[i - 1]);
      log.linear_speed_m_s[i] = vx[i] * std::cos(middle) + vy[i] * std::sin(middle);
    }
    tell("linear_speed_m_s");
  }
  if (log.angular_speed_rad_s.empty()) {
    log.angular_speed_rad_s = change_per_second(log.time_s, heading);
    tell("angular_speed_rad_s");
  }
}

/// Wheel speeds from body speeds [P1, Eqs. (2), (3)]; body speeds from the pose where there are no others.
/// True where the wheels' speeds come from the body's.
bool derive_speeds(Trajectory& log, const Geometry& geometry, const std::string& run,
                   std::vector<LogArtifact>& artifacts) {
  if (!log.wheel_speed_rad_s.left.empty()) return false;
  derive_body_speeds(log, run, artifacts);
  if (log.linear_speed_m_s.empty() || log.angular_speed_rad_s.empty()) return false;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const Sided<double> wheels =
        wheel_speeds_rad_s(geometry, log.linear_speed_m_s[i], log.angular_speed_rad_s[i]);
    for (const Side side : kSides) log.wheel_speed_rad_s[side].push_back(wheels[side]);
  }
  artifacts.push_back({"derived", run, "wheel_speed_left_rad_s, wheel_speed_right_rad_s",
                       "from linear and angular speed", log.size(), 0.0});
  return true;
}

void sign_unsigned_channels(Trajectory& log, const ColumnSources& sources, const std::string& run,
                            RunLog& result) {
  for (const auto& [name, source] : sources) {
    const LogColumn* column = find_log_column(name);
    if (!source.is_unsigned || !column || column->channel(log).empty()) continue;
    const Side side = name.find("left") != std::string::npos ? Side::left : Side::right;
    const auto& speed = log.wheel_speed_rad_s[side];
    auto& values = column->channel(log);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (speed[i] < 0.0) values[i] = -values[i];
    if (name.rfind("motor_current", 0) == 0) result.current_sign_from_motion = true;
    result.artifacts.push_back(
        {"unsigned", run, name,
         "the log has no sign; it is taken from the wheel's motion, so braking looks like driving",
         values.size(), 0.0});
  }
}

void start_epoch_clock_at_zero(RunLog& log, HoldsOfChannel& holds, const std::string& run) {
  auto& times = log.trajectory.time_s;
  const double start_s = times.front();
  if (std::abs(start_s) < kEpochClock_s) return;
  for (double& time_s : times) time_s -= start_s;
  log.clock_origin_s = start_s;
  for (auto& [channel, of_channel] : holds)
    for (Hold& hold : of_channel.of_reported_length) hold.from_s -= start_s, hold.to_s -= start_s;
  char text[96];
  std::snprintf(text, sizeof text, "the clock begins at %.3f s; times are relative to it", start_s);
  log.artifacts.push_back({"clock_origin", run, "time_s", text, 1, 0.0});
}

}  // namespace

RunLog read_run_log(const std::vector<LogFileName>& names, const ColumnSources& given,
                    const Geometry& geometry, const std::string& run) {
  RunLog log;
  ColumnSources wanted = given;
  std::vector<LogFile> files;
  std::vector<std::string> headers;
  for (const auto& name : names) {
    const LogReader* reader = name.table ? nullptr : log_reader_of(name.file, name.named_by);
    if (!reader) {
      files.push_back(read_log_file(name, given, run));
      std::ranges::copy(files.back().table.header, std::back_inserter(headers));
      continue;
    }
    LogTables read = reader->read(name.file, name.named_by, given, run);
    log.artifacts.insert(log.artifacts.end(), read.artifacts.begin(), read.artifacts.end());
    for (auto& [column, source] : wanted)
      if (!source.from.empty() && !source.is_absent)
        std::ranges::copy(read.sources.at(column).from, std::back_inserter(source.from));
    read.sources.erase("time_s");
    for (CsvTable& table : read.tables) files.push_back(read_log_table(std::move(table), read.sources, run));
  }
  check_mapped_columns_found(files, wanted, headers);
  const std::vector<std::string> ignored = ignored_columns(headers, given);
  for (const auto& file : files)
    log.artifacts.insert(log.artifacts.end(), file.artifacts.begin(), file.artifacts.end());
  HoldsOfChannel holds = merge(files, log, run);
  refuse_mistyped(ignored, missing_columns(log.trajectory, given), names.front().file);
  refuse_one_wheel(log.trajectory, names.front().file);
  log.wheels_from_body_speeds = derive_speeds(log.trajectory, geometry, run, log.artifacts);
  refuse_no_motion(log.trajectory, names.front().file);
  start_epoch_clock_at_zero(log, holds, run);
  auto odd = find_artifacts(log.trajectory, holds, run);
  log.artifacts.insert(log.artifacts.end(), odd.begin(), odd.end());
  sign_unsigned_channels(log.trajectory, given, run, log);
  note_ignored(ignored, log, run);
  return log;
}

RunLog read_run_log(const std::string& file, const Geometry& geometry) {
  RunLog log = read_run_log({{file, {}}}, {}, geometry, file);
  drop_partial_channels(log.trajectory, file, log.artifacts);
  return log;
}

std::string run_log_text(const Trajectory& trajectory, const CsvColumns& extra) {
  CsvColumns columns;
  for (const auto& column : log_columns())
    if (const auto& values = column.of(trajectory); !values.empty())
      columns.emplace_back(column.name, &values);
  columns.insert(columns.end(), extra.begin(), extra.end());
  return csv_text(columns);
}

}  // namespace joulepath
