#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/monitor/monitor_row.hpp"
#include "model/kinematics.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Rows of a log that arrives line by line: CSV with a header, or one JSON object per line. Columns have the
/// names of the run log format; others are ignored. Nothing in a line is an error: a cell without a number is
/// absent, a line without any known column gives a row without a time.
class LogLines {
 public:
  explicit LogLines(const Geometry& geometry) : geometry_(geometry) {}

  /// The row of a line; nothing for a header, a comment or an empty line.
  [[nodiscard]] std::optional<MonitorRow> row(std::string_view line);

 private:
  void read_header(std::string_view line);
  [[nodiscard]] MonitorRow csv_row(std::string_view line) const;
  [[nodiscard]] MonitorRow json_row(std::string_view line) const;
  [[nodiscard]] MonitorRow finished(MonitorRow row, const Twist<double>& body) const;

  Geometry geometry_;
  char separator_{};
  std::vector<std::size_t> column_{};  ///< of the known columns, per column of the file
};

/// Row k of a log in memory.
[[nodiscard]] MonitorRow monitor_row(const Trajectory& log, std::size_t k);

}  // namespace joulepath
