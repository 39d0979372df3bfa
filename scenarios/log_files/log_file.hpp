#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/log_files/log_repair.hpp"
#include "scenarios/text/csv_table.hpp"

namespace joulepath {

/// A log file and the place of its name (for messages).
struct LogFileName {
  std::string file{};
  NamedBy named_by{};
  const CsvTable* table{};  ///< its content, if it is already in memory
};

/// One file of a run: its columns in the format's names and units, at its own times.
struct LogFile {
  CsvTable table{};  ///< as read, without its columns
  std::vector<double> times{};
  std::map<std::string, std::vector<double>> channels{};
  HoldsOfChannel holds{};  ///< of the readings of channels that have rows between them
  std::vector<LogArtifact> artifacts{};
};

/// The names that a file may use for one of the format's columns.
[[nodiscard]] std::vector<std::string> names_in_file(const std::string& column, const ColumnSources& sources);

/// Reads one file of a run. Throws ConfigError: no time, times that do not increase, malformed cells.
[[nodiscard]] LogFile read_log_table(CsvTable table, const ColumnSources& sources, const std::string& run);
[[nodiscard]] LogFile read_log_file(const LogFileName& name, const ColumnSources& sources,
                                    const std::string& run);

}  // namespace joulepath
