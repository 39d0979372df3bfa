#pragma once

#include <string>

#include "diagnosis/monitor/monitor.hpp"

namespace joulepath {

/// What a monitor needs of a plan's directory: trajectory.csv, and plan.json for the legs' uncertainty and
/// the battery. Throws ConfigError.
[[nodiscard]] PlannedCourse read_planned_course(const std::string& directory, const Robot& robot);

/// One line of JSON (schema joulepath/monitor/1) for an event.
[[nodiscard]] std::string monitor_json(const MonitorEvent& event);
/// One line to read.
[[nodiscard]] std::string monitor_text(const MonitorEvent& event);

}  // namespace joulepath
