#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/csv_table.hpp"
#include "scenarios/log_columns.hpp"

namespace joulepath {

/// Whether a file is a log by itself, not a dataset that names logs: CSV or a bag.
[[nodiscard]] bool is_log_file(const std::string& file);

/// The wanted columns of a bag, one table per topic, that of the wheels (or the body) first. Their columns
/// have the names of the sources; `time_s` is the header's stamp, or the log time where there is none.
struct BagLog {
  std::vector<CsvTable> tables{};
  ColumnSources sources{};  ///< those given, or the suggested ones where none are
  std::vector<LogArtifact> artifacts{};
};

/// Reads a bag. Messages out of order are sorted, repeated ones dropped, broken ones counted, and each is
/// told. Throws ConfigError where nothing that is wanted is there.
[[nodiscard]] BagLog read_bag_log(const std::string& file, const NamedBy& named_by,
                                  const ColumnSources& sources, const std::string& run);

}  // namespace joulepath
