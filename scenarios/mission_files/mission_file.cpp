#include "scenarios/mission_files/mission_file.hpp"

#include <algorithm>
#include <filesystem>

#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/mission_files/motion_entry.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {
namespace {

std::map<std::string, Station> read_stations(const Node& node) {
  std::map<std::string, Station> stations;
  for (const auto& [name, place] : node.entries())
    stations[name] = {.x_m = place["x_m"].number(),
                      .y_m = place["y_m"].number(),
                      .heading_rad = place.optional_number("heading_rad"),
                      .charger_W = place.number_or("charger_W", 0.0),
                      .marks = marks_of(place)};
  return stations;
}

/// A station's name, which must be one of the mission's stations.
std::string station_named(const Node& node, const std::map<std::string, Station>& stations) {
  const std::string& name = node.text();
  if (stations.contains(name)) return name;
  std::vector<std::string> names;
  for (const auto& [station, place] : stations) names.push_back(station);
  const std::string near = nearest_word(name, names);
  node.fail(names.empty() ? "a station; this mission has no stations"
                          : "one of the stations: " + text_of_list(names),
            near.empty() ? "" : "did you mean " + near + "?");
}

StartRequest read_start(const Node& node, const std::map<std::string, Station>& stations) {
  StartRequest start{.battery_fraction = node.optional_number("battery_fraction"), .marks = marks_of(node)};
  const auto heading = node.optional_number("heading_rad");
  if (const auto name = node.find("station")) {
    start.station = station_named(*name, stations);
    const Station& station = stations.at(start.station);
    for (const char* key : {"x_m", "y_m"})
      if (const auto extra = node.find(key)) extra->fail("a station or a position, not both");
    start.heading_given = heading || station.heading_rad;
    start.pose = {station.x_m, station.y_m, heading.value_or(station.heading_rad.value_or(0.0))};
  } else {
    start.heading_given = heading.has_value();
    start.pose = {node["x_m"].number(), node["y_m"].number(), heading.value_or(0.0)};
  }
  return start;
}

PayloadAlongLeg read_payload_along(const Node& node) {
  if (node.kind() == Value::Kind::map) return {node["from"].number(), node["to"].number()};
  return {node.number(), node.number()};
}

LegRequest read_leg(const Node& node, const std::map<std::string, Station>& stations) {
  LegRequest leg{.dwell_s = node.number_or("dwell_s", 0.0),
                 .deadline_s = node.optional_number("deadline_s"),
                 .duration_s = node.optional_number("duration_s"),
                 .start_speed_m_s = node.number_or("start_speed_m_s", 0.0),
                 .end_speed_m_s = node.number_or("end_speed_m_s", 0.0),
                 .marks = marks_of(node)};
  if (const auto to = node.find("to")) leg.to = station_named(*to, stations);
  if (const auto path = node.find("path"))
    leg.path = PathRequest{read_bezier((*path)["bezier_m"]), path->text_or("frame", "start") == "map"
                                                                 ? PathRequest::Frame::map
                                                                 : PathRequest::Frame::start};
  if (const auto motion = node.find("motion")) leg.motion = read_motion(*motion);
  if (const auto payload = node.find("payload_kg")) leg.payload = read_payload_along(*payload);
  if (const auto direction = node.find("direction")) {
    if (leg.to.empty()) direction->fail("no such key", "a given path or motion has its own direction");
    const std::string name = direction->text();
    leg.direction = name == "reverse"   ? LegDirection::reverse
                    : name == "forward" ? LegDirection::forward
                                        : LegDirection::any;
  }
  if (leg.motion)
    for (const char* key : {"deadline_s", "duration_s", "start_speed_m_s", "end_speed_m_s"})
      if (const auto extra = node.find(key))
        extra->fail("no such key", "a prescribed motion has its own times and speeds");
  return leg;
}

VisitRequest read_visit(const Node& node, const std::map<std::string, Station>& stations) {
  VisitRequest visit{.payload_kg = node.number_or("payload_kg", 0.0),
                     .payload_given = node.has("payload_kg"),
                     .dwell_s = node.number_or("dwell_s", 0.0),
                     .marks = marks_of(node)};
  visit.kind = node.has("pick")   ? VisitRequest::Kind::pick
               : node.has("drop") ? VisitRequest::Kind::drop
                                  : VisitRequest::Kind::pass;
  const char* key = visit.kind == VisitRequest::Kind::pick   ? "pick"
                    : visit.kind == VisitRequest::Kind::drop ? "drop"
                                                             : "go";
  visit.station = station_named(node[key], stations);
  if (visit.kind == VisitRequest::Kind::pick && !visit.payload_given)
    node.fail("payload_kg together with pick", "payload_kg is the mass that the robot picks up here");
  if (visit.kind == VisitRequest::Kind::pass && visit.payload_given)
    node["payload_kg"].fail("no such key", "go has no payload change");
  if (const auto window = node.find("window_s")) {
    const auto ends = window->items();
    visit.window_s = {ends[0].number(), ends[1].number()};
    if (visit.window_s->first > visit.window_s->second)
      window->fail_found("a window that ends before it begins", "[earliest, latest]");
  }
  return visit;
}

std::vector<SpeedZone> read_speed_zones(const Node& node, std::size_t legs) {
  std::vector<SpeedZone> zones;
  for (const auto& item : node.items()) {
    SpeedZone zone{.leg = static_cast<std::size_t>(item["leg"].integer()),
                   .from_m = item["from_m"].number(),
                   .to_m = item["to_m"].number(),
                   .speed_m_s = item["speed_m_s"].number(),
                   .marks = marks_of(item)};
    if (zone.leg >= legs)
      item["leg"].fail("a leg of this mission, 0 to " + std::to_string(legs - 1), "legs are counted from 0");
    if (zone.from_m >= zone.to_m) item["to_m"].fail("a number > from_m");
    zones.push_back(zone);
  }
  return zones;
}

ChargingRequest read_charging(const Node& node, const std::map<std::string, Station>& stations) {
  ChargingRequest charging{.to_fraction = node.number_or("to_fraction", 0.8), .marks = marks_of(node)};
  if (const auto names = node.find("stations")) {
    for (const auto& name : names->items()) {
      charging.stations.push_back(station_named(name, stations));
      if (stations.at(charging.stations.back()).charger_W <= 0)
        name.fail("a station with charger_W", "charger_W is the power of the charger there");
    }
    return charging;
  }
  for (const auto& [name, station] : stations)
    if (station.charger_W > 0) charging.stations.push_back(name);
  if (charging.stations.empty()) node.fail_found("no station with charger_W", "at least one");
  return charging;
}

Objective read_objective(const Node& node) {
  const std::string word = node.text_or("minimize", "energy");
  Objective objective{.deadline_s = node.optional_number("deadline_s"),
                      .time_value_W = node.number_or("time_value_W", 0.0),
                      .confidence = node.optional_number("confidence"),
                      .marks = marks_of(node)};
  objective.minimize = word == "time"              ? Objective::Minimize::time
                       : word == "energy_and_time" ? Objective::Minimize::energy_and_time
                                                   : Objective::Minimize::energy;
  const auto value = node.find("time_value_W");
  if (word == "energy_and_time" && !value)
    node.fail("time_value_W together with energy_and_time", "time_value_W is the value of a second in watts");
  if (word != "energy_and_time" && value)
    value->fail("no such key", "only allowed with minimize: energy_and_time");
  return objective;
}

std::map<std::string, double> figures_by_name(const Node& root, const char* key) {
  std::map<std::string, double> figures;
  if (const auto entries = root.find(key))
    for (const auto& [name, figure] : entries->entries()) figures[name] = figure.number();
  return figures;
}

/// Checks that relate several parts of a mission.
void check_consistency(const Node& root, const MissionRequest& mission) {
  const int ways = int(root.has("legs")) + int(root.has("visit")) + int(root.has("order"));
  const bool empty = mission.legs.empty() && mission.visit.empty() && mission.order_file.empty();
  if (empty) root.fail_found("a mission without stops", "legs, visit or order with at least one entry");
  if (ways > 1 && !(root.has("legs") && mission.legs.empty()) &&
      !(root.has("visit") && mission.visit.empty()))
    root.fail_found("more than one of legs, visit, order", "one of them");
  for (const char* key : {"payload_by_action", "dwell_by_action_s"})
    if (root.has(key) && !root.has("order")) root[key].fail("no such key", "only allowed with order:");
  const bool graph_or_map = !mission.map_file.empty() || !mission.route_graph_file.empty();
  for (const auto& leg : mission.legs)
    if (!leg.to.empty() && !leg.path && !graph_or_map)  // along edges of an order it has
      throw ConfigError({leg.marks.at("to"), leg.marks.key_path("to"), "a leg to a station, but no map",
                         "map: with the name of a Nav2 map file",
                         "without a map every leg needs its path or motion"});
  if (!mission.visit.empty() && !graph_or_map)
    root["visit"].fail("a mission with a map", "name it with map:");
}

SpeedMaskRequest read_speed_mask(const Node& node, const ReadOptions& options) {
  const bool absolute = node.text_or("kind", "percent") == "absolute";
  return {resolve_file(node["file"], options),
          absolute ? SpeedMask::Kind::absolute : SpeedMask::Kind::percent, node.number_or("base", 100.0),
          node.number_or("multiplier", -1.0)};
}

}  // namespace

ItemMarks marks_of(const Node& node) {
  ItemMarks marks{.path = node.path(), .item = node.mark()};
  for (const auto& [key, value] : node.entries()) marks.keys[key] = value.mark();
  return marks;
}

MissionRequest mission_from(const Document& document, const ReadOptions& options) {
  static const Schema schema = mission_schema();
  refuse_absent_document(document);
  const Node root = document.root();
  if (root.kind() == Value::Kind::map)
    for (const auto& [key, node] : root.entries()) refuse_absent_word("key", key, node);
  check_document(document, "mission", schema);
  if (const auto map = root.find("map"), stations = root.find("stations");
      map && stations && stations->has(map->text()))
    map->fail_found("the station " + map->text(), "the name of a Nav2 map file (YAML)");
  const auto file_named = [&](const char* key) {
    const auto node = root.find(key);
    return node ? resolve_file(*node, options) : std::string();
  };
  MissionRequest mission{
      .file = document.file(),
      .name = root.text_or("name", printable(std::filesystem::path(document.file()).stem().string())),
      .robot_file = file_named("robot"),
      .map_file = file_named("map"),
      .unknown_is_floor = root.text_or("unknown", "occupied") == "free",
      .keepout_file = file_named("keepout"),
      .route_graph_file = file_named("route_graph"),
      .clearance_m = root.number_or("clearance_m", 0.0),
      .order_file = file_named("order"),
      .payload_by_action = figures_by_name(root, "payload_by_action"),
      .dwell_by_action_s = figures_by_name(root, "dwell_by_action_s"),
      .marks = marks_of(root)};
  if (const auto mask = root.find("speed_mask")) mission.speed_mask = read_speed_mask(*mask, options);
  if (const auto stations = root.find("stations")) mission.stations = read_stations(*stations);
  if (const auto start = root.find("start")) mission.start = read_start(*start, mission.stations);
  if (const auto legs = root.find("legs"))
    for (const auto& leg : legs->items()) mission.legs.push_back(read_leg(leg, mission.stations));
  if (const auto visits = root.find("visit"))
    for (const auto& visit : visits->items()) mission.visit.push_back(read_visit(visit, mission.stations));
  for (const MissionKey& known : registry().mission_keys)
    if (const auto node = root.find(known.key); node && known.read) known.read(mission, *node);
  if (const auto zones = root.find("speed_zones"))
    for (SpeedZone& zone : read_speed_zones(*zones, mission.legs.size()))
      mission.speed_zones.push_back(std::move(zone));
  if (const auto objective = root.find("objective")) mission.objective = read_objective(*objective);
  if (const auto charging = root.find("charging"))
    mission.charging = read_charging(*charging, mission.stations);
  check_consistency(root, mission);
  return mission;
}

const MissionDocument* mission_document_of(const Document& document) {
  for (const MissionDocument& known : registry().mission_documents)
    if (known.recognizes(document)) return &known;
  return nullptr;
}

MissionRequest read_mission(const std::string& file, const ReadOptions& options) {
  const Document document = Document::load(file);
  if (const MissionDocument* other = mission_document_of(document))
    throw ConfigError(
        {{file, 1, 1}, "", other->says + ", which names no robot", "a mission file", other->use});
  return mission_from(document, options);
}

}  // namespace joulepath
