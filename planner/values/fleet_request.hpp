#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/values/mission_request.hpp"

namespace joulepath {

struct FleetRobot {
  std::string name{};
  std::string robot_file{};
  std::string start{};  ///< name of a station
  std::optional<double> battery_fraction{};
  ItemMarks marks{};
};

struct FleetCharger {
  std::string station{};
  int count{1};
  double power_W{};
  ItemMarks marks{};
};

/// Several robots, few chargers, many missions.
struct Fleet {
  std::string file{};
  std::vector<FleetRobot> robots{};
  std::vector<FleetCharger> chargers{};
  std::vector<std::string> mission_files{};
  std::vector<ItemMarks> mission_marks{};  ///< the place of each name in the file
};

}  // namespace joulepath
