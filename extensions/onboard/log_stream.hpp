#pragma once

#include <functional>
#include <istream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/onboard/monitor/monitor_row.hpp"
#include "model/kinematics.hpp"
#include "model/log_columns.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Rows of a log that arrives line by line: CSV with a header, or one JSON object per line. Columns have the
/// names of the run log format; others are ignored. A header without a time or without speeds is an error, so
/// is one with a column twice, and so is a line of more than 1 MiB. Nothing else in a later line is: a cell
/// without a number is absent, a line without any known column, and an object with a key twice, give a row
/// without a time.
class LogLines {
 public:
  /// `file`: the name of the log in errors.
  LogLines(const Geometry& geometry, std::string file) : geometry_(geometry), file_(std::move(file)) {}

  /// The row of a line; nothing for a header, a comment or an empty line. Throws ConfigError for a header
  /// that no row can be used with, and for a line that is too long.
  [[nodiscard]] std::optional<MonitorRow> row(std::string_view line);

  /// Calls `use` with each row of a stream as it grows, until it ends. Throws as row() does, for a line that
  /// is too long before it ends.
  void follow(std::istream& stream, const std::function<void(const MonitorRow&)>& use);

 private:
  void read_header(std::string_view line);
  [[nodiscard]] MonitorRow csv_row(std::string_view line);
  [[nodiscard]] MonitorRow json_row(std::string_view line);
  void clear();
  [[nodiscard]] MonitorRow finished() const;

  Geometry geometry_;
  std::string file_;
  int line_{};
  bool has_json_{};  ///< rows are JSON: another line is a broken row, not a header
  char separator_{};
  std::vector<const LogColumn*> column_{};  ///< per column of the file; null for one that no log has
  Trajectory row_{};                        ///< of one sample: the line that is read
};

/// Row k of a log in memory.
[[nodiscard]] MonitorRow monitor_row(const Trajectory& log, std::size_t k);

}  // namespace joulepath
