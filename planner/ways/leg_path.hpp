#pragma once

#include <optional>

#include "planner/legs/stretch.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The path of a leg, or the reason why there is none.
struct LegPath {
  Path path{};
  std::string source{};  ///< bezier | ompl_bitstar | ...
  std::optional<Infeasibility> infeasibility{};
  std::vector<PathAlternative> alternatives{};
  std::vector<WayImprovement> improvements{};
};

/// Start of a leg. A station that names no heading leaves the heading open.
struct LegStart {
  Pose pose{};
  bool heading_free{};
};

/// Finds the way of one leg from the robot's pose; a given path is checked against the map. Throws
/// ConfigError, with the marks of the leg, for mistakes in the file (a curve with a cusp, a start inside an
/// obstacle, a missing map).
[[nodiscard]] LegPath leg_path(const LegRequest& leg, std::size_t leg_index, const LegStart& start,
                               const MissionRequest& mission, const RouteSpace* space,
                               const PlanOptions& options);

/// The route search of a leg to a station.
[[nodiscard]] RouteRequest route_request(const LegRequest& leg, const LegStart& start,
                                         const MissionRequest& mission, const PlanOptions& options);

/// Throws ConfigError where the robot does not fit at the mission's start, from which `way` begins.
void refuse_blocked_start(const MissionRequest& mission, const RouteSpace& space, const RouteRequest& way);

/// Throws ConfigError at a station that the mission goes to and where the robot does not fit; not where it
/// does not fit at the start, either.
void refuse_blocked_goals(const MissionRequest& mission, const RouteSpace& space);

}  // namespace joulepath
