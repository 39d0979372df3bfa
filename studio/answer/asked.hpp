#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/mission/mission.hpp"

namespace joulepath::studio {

/// The mission and the robot of a question. Throws ConfigError as the readers of their files do. File names
/// are relative to `folder`.
struct Asked {
  MissionRequest mission{};
  Robot robot{};
};
[[nodiscard]] Asked asked_from(const nlohmann::json& question, const std::string& folder);

/// Gives every leg to a station the path of an earlier answer, moved to the present places of its stops.
/// Throws ConfigError where there is none.
void follow_paths(MissionRequest& mission, const nlohmann::json& paths, const Plant& plant);

}  // namespace joulepath::studio
