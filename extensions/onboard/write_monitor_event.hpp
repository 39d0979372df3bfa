#pragma once

#include <string>

#include "extensions/onboard/monitor/monitor.hpp"

namespace joulepath {

/// One line of JSON (schema joulepath/monitor/1) for an event.
[[nodiscard]] std::string monitor_json(const MonitorEvent& event);
/// One line to read.
[[nodiscard]] std::string monitor_text(const MonitorEvent& event);
/// How many rows were used and why others were not.
[[nodiscard]] std::string row_counts_text(const RowCounts& rows);

}  // namespace joulepath
