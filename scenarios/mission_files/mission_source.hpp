#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/path/geometry/path.hpp"
#include "planner/values/mission_request.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The input of a planning command: a mission, a VDA 5050 order or a path, and its options.
struct MissionSource {
  std::string file{};
  std::string robot_file{};             ///< replaces the mission's; orders and paths name none
  std::string map_file{};               ///< replaces the mission's
  bool robot_at_hand{};                 ///< the caller provides the robot: no file needs to name one
  std::optional<double> payload_kg{};   ///< paths only
  std::optional<double> duration_s{};   ///< paths only; absent: the time of least energy
  std::optional<double> tolerance_m{};  ///< of points of a path; absent: as read_waypoints() says
};

/// Throws ConfigError where neither the source nor the caller names a robot. `input`: "a path".
void need_robot(const MissionSource& source, const std::string& input);

/// The file given by the option --KEY, if any, replaces the one of this key; errors about it name the option.
void replace_file(MissionRequest& mission, const std::string& key, std::string MissionRequest::*file,
                  const std::string& given);

/// One leg along a path, from rest to rest.
[[nodiscard]] MissionRequest mission_along(const MissionSource& source, Path path);

/// The mission of a source; for a path one leg along it, from rest to rest. `notes` gets what the reader
/// decided that the user should know.
[[nodiscard]] MissionRequest read_mission_source(const MissionSource& source, const ReadOptions& options = {},
                                                 std::vector<std::string>* notes = nullptr);

}  // namespace joulepath
