#include "extensions/fleet/fleet_file.hpp"
#include "extensions/fleet/fleet_floor.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"
// Design: docs/decisions/0701-python.md

namespace joulepath {
namespace {

FileSummary check_fleet_file(const std::string& file, const ReadOptions& options) {
  const FleetFloor floor = read_fleet_floor(read_fleet(file, options), options);
  return {"fleet",
          counted(floor.fleet.robots.size(), "robot") + ", " +
              counted(floor.fleet.missions.size(), "mission") + ", " +
              counted(floor.fleet.chargers.size(), "charger"),
          fleet_notes(floor.fleet)};
}

}  // namespace

void add_fleet(Registry& registry) {
  registry.files.push_back({.kind = "fleet", .key = "missions", .check = check_fleet_file});
  registry.kinds.push_back({"fleet", fleet_schema, "robots, chargers and missions of a fleet"});
}

}  // namespace joulepath
