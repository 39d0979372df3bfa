#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/csv_table.hpp"
#include "scenarios/log_columns.hpp"

namespace joulepath {

/// Whether a file is a log by itself, not a dataset that names logs: CSV or a bag.
[[nodiscard]] bool is_log_file(const std::string& file);
/// Of these, one with times: a CSV file of waypoints has none.
[[nodiscard]] bool is_run_log(const std::string& file);

/// The requested columns of a bag, one table per topic, that of the wheels (or the body) first. Their columns
/// have the names of the sources; `time_s` is the header's stamp, or the log time without a stamp.
struct BagLog {
  std::vector<CsvTable> tables{};
  ColumnSources sources{};  ///< the given ones, and the suggested ones of other columns
  std::vector<LogArtifact> artifacts{};
};

/// Reads a bag. Messages out of order are sorted, repeated ones dropped, broken ones counted; each case is
/// reported. Throws ConfigError if no requested column is present.
[[nodiscard]] BagLog read_bag_log(const std::string& file, const NamedBy& named_by,
                                  const ColumnSources& sources, const std::string& run);

}  // namespace joulepath
