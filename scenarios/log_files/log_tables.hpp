#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/csv_table.hpp"

namespace joulepath {

/// A log of several sources in one file, one table each, that of the wheels (or the body) first. Their
/// columns have the names of the sources.
struct LogTables {
  std::vector<CsvTable> tables{};
  ColumnSources sources{};  ///< the given ones, and the suggested ones of other columns
  std::vector<LogArtifact> artifacts{};
};

/// The reader of a log that is no CSV file; null for other files. Throws ConfigError for a file that needs an
/// extension which this program was built without.
[[nodiscard]] const LogReader* log_reader_of(const std::string& file, const NamedBy& named_by = {});

/// The formats of logs in words: "CSV, bag".
[[nodiscard]] std::string log_formats();

/// Whether a file is a log by itself, not a dataset that names logs: CSV, or one of a LogReader.
[[nodiscard]] bool is_log_file(const std::string& file);
/// Of these, one with times: a CSV file of waypoints has none.
[[nodiscard]] bool is_run_log(const std::string& file);

}  // namespace joulepath
