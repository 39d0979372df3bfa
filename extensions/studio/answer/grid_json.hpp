#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planner/values/mission_request.hpp"

namespace joulepath::studio {

/// A map as JSON: {width, height, resolution_m, origin: [x_m, y_m, heading_rad], runs: [percent, count,
/// ...]}, cells row-major from the bottom row, -1 unknown.
[[nodiscard]] nlohmann::json grid_json(const OccupancyGrid& grid);
[[nodiscard]] OccupancyGrid grid_from(const nlohmann::json& grid);

/// The floor of a mission: {map, keepout, speed_mask: {grid, absolute, base, multiplier}}, each may be null.
/// The robot and the route graph are not included.
[[nodiscard]] nlohmann::json floor_json(const MissionWorld& world);
[[nodiscard]] MissionWorld floor_from(const nlohmann::json& floor);

}  // namespace joulepath::studio
