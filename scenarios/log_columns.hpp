#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/trajectory.hpp"
#include "scenarios/schema.hpp"

namespace joulepath {

/// A column of the run log format and the channel of a Trajectory that it fills.
struct LogColumn {
  std::string name{};
  std::vector<double>& (*channel)(Trajectory&){};
  bool measured{};  ///< a run log may have it; the others only `plan` writes

  [[nodiscard]] const std::vector<double>& of(const Trajectory& trajectory) const {
    return channel(const_cast<Trajectory&>(trajectory));  // it only finds the channel
  }
};

/// All columns, in the order in which they are written.
[[nodiscard]] const std::vector<LogColumn>& log_columns();
[[nodiscard]] const LogColumn* find_log_column(const std::string& name);

/// Columns that are no channel themselves: the quaternion that a heading can come from.
inline constexpr const char* kOrientationColumns[] = {"orientation_w", "orientation_x", "orientation_y",
                                                      "orientation_z"};

/// Where a column comes from in a log with other names or units: value = scale * x + offset.
struct ColumnSource {
  std::vector<std::string> from{};  ///< the first of these that the file has; empty: the column's own name
  double scale{1.0};
  double offset{0.0};
  bool is_unsigned{};                ///< the sign is taken from the wheel's motion
  std::optional<double> wraps_at{};  ///< a counter that starts again at 0 there (in the log's unit)
  bool derivative{};  ///< the change per second of what is logged, over the sample period before
  double delay_s{};   ///< the channel shows what was so long ago
  SourceMark mark{};
};
using ColumnSources = std::map<std::string, ColumnSource>;

[[nodiscard]] Schema column_sources_schema();
[[nodiscard]] ColumnSources read_column_sources(const Node& node);

}  // namespace joulepath
