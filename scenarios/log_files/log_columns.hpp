#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/log_columns.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// Columns that are not channels: the quaternion from which a heading is computed.
inline constexpr const char* kOrientationColumns[] = {"orientation_w", "orientation_x", "orientation_y",
                                                      "orientation_z"};

/// Source of a column in a log with other names or units: value = scale * x + offset.
struct ColumnSource {
  /// The first of these that exists in the file; empty: the column's own name.
  std::vector<std::string> from{};
  double scale{1.0};
  double offset{0.0};
  bool is_unsigned{};                ///< the sign comes from the wheel's motion
  std::optional<double> wraps_at{};  ///< value at which a counter restarts at 0 (in the log's unit)
  bool derivative{};  ///< use the change per second of the logged value, over the sample period before
  double delay_s{};   ///< delay of the channel's readings
  bool is_absent{};   ///< the column is not read
  SourceMark mark{};
};
using ColumnSources = std::map<std::string, ColumnSource>;

[[nodiscard]] Schema column_sources_schema();
[[nodiscard]] ColumnSources read_column_sources(const Node& node);
/// The columns of a run: its own `columns:`, else those of the dataset.
[[nodiscard]] ColumnSources sources_of_run(const Node& run, ColumnSources of_dataset);

}  // namespace joulepath
