#pragma once

#include <nlohmann/json.hpp>

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// The loss at the controller's own time and at the plan's; the latter is null if the controller is later.
[[nodiscard]] nlohmann::ordered_json loss_json(const ControllerLoss& loss);

}  // namespace joulepath
