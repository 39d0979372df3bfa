#pragma once

#include <nlohmann/json.hpp>

#include "planner/controller/planned_speed.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {

/// The order that a mission names, with the speeds of its edges lowered to the planned ones; all else is
/// unchanged.
[[nodiscard]] nlohmann::ordered_json order_with_speeds(const ExportInput& input, const PartSpeeds& speeds);

/// A VDA 5050 order (3.0.0) of a plan: an edge per segment of its curves, bent ones as NURBS trajectories
/// within 1 mm, a node between any two, dwells as actions `wait`. Throws ConfigError for prescribed motions.
[[nodiscard]] nlohmann::ordered_json order_of_plan(const ExportInput& input, const PartSpeeds& speeds);

/// The order of a mission or of a plan with speeds that a controller without profile follows, and its energy
/// loss.
[[nodiscard]] Export export_vda5050(const ExportInput& input);

}  // namespace joulepath
