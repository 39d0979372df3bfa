#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "planner/values/mission_request.hpp"

namespace joulepath {

struct FleetRobot {
  std::string name{};
  std::string robot_file{};
  std::string start{};  ///< name of a station
  double battery_fraction{1.0};
  double from_s{};                                       ///< available from here ...
  double to_s{std::numeric_limits<double>::infinity()};  ///< ... to here
  double use_price_J{};                                  ///< if it drives any mission
  ItemMarks marks{};
};

/// The energy that a charger gives grows in two linear pieces: `power_W` up to the knee, `taper_W` above it.
struct FleetCharger {
  std::string station{};
  int count{1};  ///< robots at a time
  double power_W{};
  double knee_fraction{1.0};  ///< of the battery
  double taper_W{};
  ItemMarks marks{};
};

struct FleetStop {
  std::string station{};
  double payload_kg{};  ///< on board from here to the next stop
  double dwell_s{};
  ItemMarks marks{};
};

/// Stops in a fixed order, without a payload on the way to the first one and after the last one.
struct FleetMission {
  std::string name{};
  std::vector<FleetStop> stops{};
  double ready_s{};                                       ///< earliest arrival at the first stop
  double due_s{std::numeric_limits<double>::infinity()};  ///< of the last stop's end
  double late_price_W{};                                  ///< joules per second late
  std::vector<std::string> robots{};                      ///< that may drive it; empty: all
  ItemMarks marks{};
};

/// Several robots on one floor, few chargers, many missions.
struct Fleet {
  std::string file{};
  std::string name{};
  MissionRequest floor{};  ///< map, masks, route graph, clearance and stations
  std::optional<double>
      energy_margin{};  ///< the error of the energy model where a robot file states no model_energy
  double payload_band_kg{};
  std::vector<FleetRobot> robots{};
  std::vector<FleetCharger> chargers{};
  std::vector<FleetMission> missions{};
  ItemMarks marks{};
};

}  // namespace joulepath
