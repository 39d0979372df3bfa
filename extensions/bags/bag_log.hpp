#pragma once

#include <string>

#include "scenarios/log_files/log_tables.hpp"

namespace joulepath {

/// Reads a bag: the requested columns, one table per topic. `time_s` is the header's stamp, or the log time
/// without a stamp. Messages out of order are sorted, repeated ones dropped, broken ones counted; each case
/// is reported. Throws ConfigError if no requested column is present.
[[nodiscard]] LogTables read_bag_log(const std::string& file, const NamedBy& named_by,
                                     const ColumnSources& sources, const std::string& run);

}  // namespace joulepath
