#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "planner/mission/mission.hpp"

namespace joulepath::studio {

/// The mission and the robot of a question. Throws ConfigError as reading their files does; `folder` is what
/// file names are relative to.
struct Asked {
  MissionRequest mission{};
  Robot robot{};
};
[[nodiscard]] Asked asked_from(const nlohmann::json& question, const std::string& folder);

/// Gives every leg to a station the path that an earlier answer gave it, moved to where its stops are now.
/// Throws ConfigError where there is none.
void follow_paths(MissionRequest& mission, const nlohmann::json& paths, const Plant& plant);

}  // namespace joulepath::studio
