#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/log_columns.hpp"
#include "scenarios/schema.hpp"

namespace joulepath {

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
  bool is_absent{};   ///< the column is not read
  SourceMark mark{};
};
using ColumnSources = std::map<std::string, ColumnSource>;

[[nodiscard]] Schema column_sources_schema();
[[nodiscard]] ColumnSources read_column_sources(const Node& node);
/// The dataset's, where the run's own `columns:` does not say otherwise.
[[nodiscard]] ColumnSources sources_of_run(const Node& run, ColumnSources of_dataset);

}  // namespace joulepath
