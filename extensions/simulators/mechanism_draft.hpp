#pragma once

#include "extensions/simulators/mechanism.hpp"
#include "scenarios/robot_files/robot_draft.hpp"

namespace joulepath {

/// The robot file's values that a model of another simulator holds. `wheels`: names of the left and the right
/// drive joint (or of the wheels); empty: the drive plugin, a transmission or an actuator names them. Throws
/// ConfigError where the drive wheels stay unknown.
[[nodiscard]] RobotDraft draft_of(const Mechanism& mechanism, const std::vector<std::string>& wheels);

}  // namespace joulepath
