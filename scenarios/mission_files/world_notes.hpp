#pragma once

#include <string>
#include <vector>

#include "planner/values/mission_request.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// What is doubtful in the files that a mission names, and between them: constants of the robot, the map's
/// meaning and resolution, speed caps far above the robot's limit, a route graph of another map. Each note
/// begins with file or key. The files were read before.
[[nodiscard]] std::vector<std::string> world_notes(const MissionRequest& mission, const MissionWorld& world,
                                                   const ReadOptions& options = {});

}  // namespace joulepath
