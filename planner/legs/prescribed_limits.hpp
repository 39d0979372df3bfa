#pragma once

#include <optional>

#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The limit that a prescribed leg exceeds most, relative to it: of the table of limits, speed zones and the
/// speed mask. Nothing if it keeps all.
[[nodiscard]] std::optional<Infeasibility> broken_limit(const LegPlan& planned, std::size_t leg,
                                                        const MissionRequest& mission,
                                                        const MissionWorld& world, const Plant& plant);

}  // namespace joulepath
