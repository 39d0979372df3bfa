#include "extensions/fleet/leg_energies.hpp"

#include <nlohmann/json.hpp>

#include "model/watt_hours.hpp"
#include "planner/mission/mission.hpp"
#include "planner/mission/plan_front.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kFrontPoints = 3;

MissionRequest leg_mission(const FleetFloor& floor, const FleetLeg& leg) {
  MissionRequest mission = floor.fleet.floor;
  const Station& start = mission.stations.at(leg.from);
  mission.name = leg.from + " to " + leg.to;
  mission.robot_file = floor.types[leg.type].robot_file;
  mission.start = {.station = leg.from,
                   .pose = {start.x_m, start.y_m, start.heading_rad.value_or(0.0)},
                   .heading_given = start.heading_rad.has_value()};
  mission.legs = {LegRequest{
      .to = leg.to, .payload = {leg.payload_kg, leg.payload_kg}, .marks = mission.stations.at(leg.to).marks}};
  return mission;
}

[[noreturn]] void refuse_leg(const FleetFloor& floor, const FleetLeg& leg, const std::string& why) {
  const ItemMarks& marks = floor.fleet.floor.stations.at(leg.to).marks;
  throw ConfigError({marks.item, marks.path,
                     "no drive from " + leg.from + " with " + floor.types[leg.type].robot_file + ": " + why,
                     "a station that the robot can reach", ""});
}

/// 1-sigma of a leg's energy as a share of it.
double relative_sigma(const Plan& plan) {
  const double energy_J = plan.energy.total_J();
  return plan.energy_sigma_J && energy_J > 0 ? *plan.energy_sigma_J / energy_J : 0.0;
}

Json robot_json(const FleetFloor& floor, std::size_t r) {
  const FleetRobot& robot = floor.fleet.robots[r];
  return {{"name", robot.name},
          {"type", floor.type_of[r]},
          {"start", robot.start},
          {"battery_fraction", robot.battery_fraction},
          {"from_s", robot.from_s},
          {"to_s", robot.to_s},
          {"use_price_J", robot.use_price_J}};
}

Json mission_json(const FleetFloor& floor, const FleetMission& mission) {
  Json stops = Json::array(), robots = Json::array();
  for (const FleetStop& stop : mission.stops)
    stops.push_back({{"station", stop.station}, {"payload_kg", stop.payload_kg}, {"dwell_s", stop.dwell_s}});
  for (std::size_t r = 0; r < floor.fleet.robots.size(); ++r)
    if (may_drive(floor, r, mission)) robots.push_back(r);
  return {{"name", mission.name},
          {"stops", stops},
          {"ready_s", mission.ready_s},
          {"due_s", mission.due_s},
          {"late_price_W", mission.late_price_W},
          {"robots", robots}};
}

Json type_json(const FleetType& type) {
  const Robot& robot = type.world.robot;
  return {{"robot_file", type.robot_file},
          {"capacity_J", kJoulesPerWh * robot.battery.capacity_Wh},
          {"reserve_fraction", robot.battery.reserve_fraction},
          {"standby_W", robot.power.standby_W}};
}

/// The keys of a mission file that state the floor.
Json floor_json(const MissionRequest& floor) {
  Json json{{"map", floor.map_file}, {"clearance_m", floor.clearance_m}};
  if (floor.unknown_is_floor) json["unknown"] = "free";
  for (const auto& [key, file] :
       {std::pair{"keepout", floor.keepout_file}, {"route_graph", floor.route_graph_file}})
    if (!file.empty()) json[key] = file;
  if (floor.speed_mask)
    json["speed_mask"] = {
        {"file", floor.speed_mask->file},
        {"kind", floor.speed_mask->kind == SpeedMask::Kind::absolute ? "absolute" : "percent"},
        {"base", floor.speed_mask->base},
        {"multiplier", floor.speed_mask->multiplier}};
  for (const auto& [name, station] : floor.stations) {
    json["stations"][name] = {{"x_m", station.x_m}, {"y_m", station.y_m}};
    if (station.heading_rad) json["stations"][name]["heading_rad"] = *station.heading_rad;
  }
  return json;
}

}  // namespace

Plan leg_plan(const FleetFloor& floor, const FleetLeg& leg, const SharedAnswers& answers) {
  const FleetType& type = floor.types[leg.type];
  const PlanOptions options{.solver = SolverChoice::fast, .baselines = false, .answers = answers};
  Plan plan = plan_mission(leg_mission(floor, leg), type.world, options, type.space.get());
  if (!is_driven(plan)) refuse_leg(floor, leg, plan.message);
  return plan;
}

std::vector<LegPoint> leg_points(const FleetFloor& floor, const FleetLeg& leg, const SharedAnswers& answers) {
  if (leg.from == leg.to) return {LegPoint{}};
  const Plan plan = leg_plan(floor, leg, answers);
  const double share = relative_sigma(plan);
  const FrontPoint rest = rest_of(plan);
  std::vector<LegPoint> points;
  const Front front = energy_time_front(planned_stretches(plan), kFrontPoints, planned_price_W(plan));
  const auto add = [&](double duration_s, double energy_J, double motion_J) {
    points.push_back({duration_s, motion_J, share * energy_J});
  };
  if (front.points.empty()) {
    add(plan.duration_s, plan.energy.total_J(), plan.energy.motion_J());
    return points;
  }
  for (const std::size_t k : {front.points.size() - 1, front.points.size() / 2, std::size_t{0}}) {
    const FrontPoint point = sum_of(front.points[k], rest);
    add(point.duration_s, point.energy_J, point.motion_energy_J);
  }
  return points;
}

std::string fleet_json(const FleetFloor& floor) {
  Json robots = Json::array(), missions = Json::array(), chargers = Json::array(), types = Json::array();
  for (std::size_t r = 0; r < floor.fleet.robots.size(); ++r) robots.push_back(robot_json(floor, r));
  for (const FleetMission& mission : floor.fleet.missions) missions.push_back(mission_json(floor, mission));
  for (const FleetCharger& charger : floor.fleet.chargers)
    chargers.push_back({{"station", charger.station},
                        {"count", charger.count},
                        {"power_W", charger.power_W},
                        {"knee_fraction", charger.knee_fraction},
                        {"taper_W", charger.taper_W}});
  for (const FleetType& type : floor.types) types.push_back(type_json(type));
  const Json json{{"name", floor.fleet.name},
                  {"file", floor.fleet.file},
                  {"payload_band_kg", floor.fleet.payload_band_kg},
                  {"floor", floor_json(floor.fleet.floor)},
                  {"types", types},
                  {"robots", robots},
                  {"chargers", chargers},
                  {"missions", missions}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace joulepath
