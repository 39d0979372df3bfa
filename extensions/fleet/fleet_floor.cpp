#include "extensions/fleet/fleet_floor.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "model/limit_table.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

/// A charger gives more than a robot's standby also when both are rounded to tenths of a watt.
constexpr double kLeastSpare_W = 0.2;

std::string figure_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

[[noreturn]] void refuse(const ItemMarks& marks, const std::string& key, std::string found,
                         std::string accepted, std::string hint = {}) {
  throw ConfigError(
      {marks.at(key), marks.key_path(key), std::move(found), std::move(accepted), std::move(hint)});
}

void check_fleet_robot(const FleetRobot& item, const Robot& robot) {
  if (!robot.limits)
    refuse(item.marks, "robot", item.robot_file + ", a robot without limits", "a robot with limits");
  if (!std::isfinite(robot.battery.capacity_Wh))
    refuse(item.marks, "robot", item.robot_file + ", a robot without battery.capacity_Wh",
           "a robot with a battery");
  if (!robot.model_energy_sigma())
    refuse(item.marks, "robot", item.robot_file + ", a robot file without model_energy in uncertainty",
           "a robot file with model_energy, or energy_margin in the fleet file",
           "the upper bound of the energy guards the battery's reserve");
  if (item.battery_fraction < robot.battery.reserve_fraction)
    refuse(item.marks, "battery_fraction", figure_text(item.battery_fraction),
           "at least the reserve, " + figure_text(robot.battery.reserve_fraction) +
               " (battery.reserve_fraction of " + item.robot_file + ")");
}

FleetType read_type(const Fleet& fleet, const FleetRobot& item, const ReadOptions& options) {
  const Robot robot = read_robot(item.robot_file, {item.marks.at("robot"), item.marks.key_path("robot")});
  MissionRequest floor = fleet.floor;
  floor.robot_file = item.robot_file;
  check_footprint(floor, robot);
  FleetType type{.robot_file = item.robot_file, .world = read_named_files(floor, options, &robot)};
  type.space =
      std::make_unique<RouteSpace>(*type.world.map, type.world.keepout ? &*type.world.keepout : nullptr,
                                   robot.footprint, floor.clearance_m);
  if (fleet.energy_margin) type.world.robot.uncertainty.try_emplace("model_energy", *fleet.energy_margin);
  return type;
}

/// A place where a robot needs to be, and the key that names it.
struct Need {
  const std::string* station{};
  const ItemMarks* marks{};
  std::string key{};
};

bool is_named(const FleetMission& mission, const std::string& robot) {
  return mission.robots.empty() || std::ranges::find(mission.robots, robot) != mission.robots.end();
}

class Checks {
 public:
  explicit Checks(const FleetFloor& floor) : floor_(floor), fleet_(floor.fleet) {}

  void run() const {
    for (std::size_t r = 0; r < fleet_.robots.size(); ++r) {
      const FleetRobot& robot = fleet_.robots[r];
      check_fleet_robot(robot, robot_of(r));
      check_standing(r, {&robot.start, &robot.marks, "start"});
      for (const FleetCharger& charger : fleet_.chargers) check_charger(r, charger);
    }
    for (const FleetMission& mission : fleet_.missions) check_mission(mission);
  }

 private:
  const Robot& robot_of(std::size_t r) const { return floor_.types[floor_.type_of[r]].world.robot; }

  RouteRequest way(std::size_t r, const std::string& to) const {
    const Station& start = fleet_.floor.stations.at(fleet_.robots[r].start);
    const Station& goal = fleet_.floor.stations.at(to);
    return {.start = {start.x_m, start.y_m, start.heading_rad.value_or(0.0)},
            .goal_x_m = goal.x_m,
            .goal_y_m = goal.y_m,
            .goal_heading_rad = goal.heading_rad,
            .start_heading_free = !start.heading_rad};
  }

  std::optional<RouteVerdict> verdict(std::size_t r, const std::string& to) const {
    const RouteSpace& space = *floor_.types[floor_.type_of[r]].space;
    if (auto blocked = blocked_ends(space, way(r, to))) return blocked;
    return no_way(space, way(r, to));
  }

  void check_standing(std::size_t r, const Need& need) const {
    if (const auto found = verdict(r, *need.station))
      refuse(*need.marks, need.key,
             *need.station + ": " + found->message + " (robot " + fleet_.robots[r].name + ")",
             "a station that the robot can reach and where it can stand");
  }

  void check_charger(std::size_t r, const FleetCharger& charger) const {
    check_standing(r, {&charger.station, &charger.marks, "station"});
    const double standby_W = robot_of(r).power.standby_W;
    for (const auto& [key, power_W] : {std::pair{"power_W", charger.power_W}, {"taper_W", charger.taper_W}})
      if (power_W < standby_W + kLeastSpare_W)
        refuse(charger.marks, key, figure_text(power_W),
               "at least " + figure_text(kLeastSpare_W) + " W more than the standby of robot " +
                   fleet_.robots[r].name + ", " + figure_text(standby_W) + " W");
  }

  /// Some robot must be able to drive it; else the reason is that of the last robot that is allowed.
  void check_mission(const FleetMission& mission) const {
    std::optional<ConfigError> reason;
    for (std::size_t r = 0; r < fleet_.robots.size(); ++r) try {
        if (!is_named(mission, fleet_.robots[r].name)) continue;
        for (const FleetStop& stop : mission.stops) {
          check_payload(stop.payload_kg, robot_of(r), fleet_.robots[r].robot_file,
                        {stop.marks.at("payload_kg"), stop.marks.key_path("payload_kg")});
          check_standing(r, {&stop.station, &stop.marks, "station"});
        }
        return;
      } catch (const ConfigError& error) {
        reason.emplace(error);
      }
    throw *reason;
  }

  const FleetFloor& floor_;
  const Fleet& fleet_;
};

}  // namespace

bool may_drive(const FleetFloor& floor, std::size_t robot, const FleetMission& mission) {
  if (!is_named(mission, floor.fleet.robots[robot].name)) return false;
  const double most_kg = payload_limit_kg(floor.types[floor.type_of[robot]].world.robot);
  return std::ranges::all_of(mission.stops,
                             [&](const FleetStop& stop) { return stop.payload_kg <= most_kg; });
}

FleetFloor read_fleet_floor(Fleet fleet, const ReadOptions& options) {
  FleetFloor floor{.fleet = std::move(fleet)};
  for (const FleetRobot& robot : floor.fleet.robots) {
    const auto same = [&](const FleetType& type) { return type.robot_file == robot.robot_file; };
    const auto known = std::ranges::find_if(floor.types, same);
    floor.type_of.push_back(static_cast<std::size_t>(known - floor.types.begin()));
    if (known == floor.types.end()) floor.types.push_back(read_type(floor.fleet, robot, options));
  }
  Checks(floor).run();
  return floor;
}

}  // namespace joulepath
