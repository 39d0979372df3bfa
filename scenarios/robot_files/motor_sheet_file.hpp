#pragma once

#include "scenarios/robot_files/robot_draft.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema motor_sheet_schema();

/// The constants of the motor that a data sheet describes (model/motor_sheet.hpp). Throws ConfigError for a
/// sheet that gives out more power than it takes, with the number.
[[nodiscard]] RobotDraft read_motor_sheet(const Document& document);

}  // namespace joulepath
