#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planner/path/geometry/path.hpp"

namespace joulepath::studio {

/// A path as JSON that reads back as the same path, to the last bit of its numbers:
///   {"turn": [x_m, y_m, heading_rad, angle_rad]}
///   {"reverse": bool, "segments": [{"arc": [x_m, y_m, heading_rad, length_m, curvature, its slope]},
///                                  {"bezier": four points}, {"rational": homogeneous points}]}
[[nodiscard]] nlohmann::json path_json(const Path& path);

/// Throws ConfigError where the JSON is not such a path.
[[nodiscard]] Path path_from(const nlohmann::json& pieces);

}  // namespace joulepath::studio
