#pragma once

#include <nlohmann/json.hpp>

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// What is lost, at the controller's own time and at the plan's; the latter is null where it is later.
[[nodiscard]] nlohmann::ordered_json loss_json(const ControllerLoss& loss);

}  // namespace joulepath
