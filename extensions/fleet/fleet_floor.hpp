#pragma once

#include <memory>
#include <vector>

#include "extensions/fleet/fleet_request.hpp"
#include "planner/path/search/route.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// A robot file of a fleet, with the floor prepared for it.
struct FleetType {
  std::string robot_file{};
  MissionWorld world{};
  std::unique_ptr<RouteSpace> space{};
};

/// A fleet with its files.
struct FleetFloor {
  Fleet fleet{};
  std::vector<FleetType> types{};      ///< each robot file once
  std::vector<std::size_t> type_of{};  ///< of each robot
};

/// Reads a fleet's files and checks all of it that needs no plan. Throws ConfigError at the key: a robot
/// without battery, limits, or both model_energy and margin; a battery below its reserve; a station where a
/// robot that needs it cannot stand, or that it cannot reach; a mission that no robot may carry; a charger
/// that is weaker than a robot's standby.
[[nodiscard]] FleetFloor read_fleet_floor(Fleet fleet, const ReadOptions& options = {});

/// Whether a robot may drive a mission: it is named, and every payload is within its limit.
[[nodiscard]] bool may_drive(const FleetFloor& floor, std::size_t robot, const FleetMission& mission);

}  // namespace joulepath
