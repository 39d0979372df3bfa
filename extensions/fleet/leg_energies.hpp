#pragma once

#include <string>
#include <vector>

#include "extensions/fleet/fleet_floor.hpp"
#include "planner/cache/answer_cache.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// One leg between two stations, as a robot drives it with a payload.
struct FleetLeg {
  std::size_t type{};
  std::string from{};
  std::string to{};
  double payload_kg{};
};

/// A speed at which a leg can be driven.
struct LegPoint {
  double duration_s{};
  double motion_J{};  ///< without standby
  double sigma_J{};   ///< 1-sigma of the energy; errors of one robot's legs are correlated
};

/// The leg as the mission planner drives it when time is free. Throws ConfigError where it cannot be driven:
/// at the key of the station.
[[nodiscard]] Plan leg_plan(const FleetFloor& floor, const FleetLeg& leg, const SharedAnswers& answers);

/// Energies of a leg at some points of its front, from the cheapest to the quickest; one point of nothing
/// where it ends at its start. Points are from a front of kFrontPoints: its cheapest, its middle and its
/// quickest. Throws as `leg_plan`.
[[nodiscard]] std::vector<LegPoint> leg_points(const FleetFloor& floor, const FleetLeg& leg,
                                               const SharedAnswers& answers);

/// A fleet for the package: numbers of robots, chargers and missions, and the types' batteries, as JSON.
[[nodiscard]] std::string fleet_json(const FleetFloor& floor);

}  // namespace joulepath
