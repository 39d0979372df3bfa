#pragma once

#include <string>

#include "extensions/onboard/monitor/planned_course.hpp"

namespace joulepath {

/// What a monitor needs of a plan's directory: trajectory.csv, and plan.json for the legs' uncertainty and
/// the battery. Throws ConfigError.
[[nodiscard]] PlannedCourse read_planned_course(const std::string& directory, const Robot& robot);

}  // namespace joulepath
