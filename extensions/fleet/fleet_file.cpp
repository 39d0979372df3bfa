#include "extensions/fleet/fleet_file.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

namespace embedded {
extern const std::string_view fleet_schemas;
}

namespace {

constexpr double kDefaultBand_kg = 5.0;
constexpr double kDefaultLatePrice_W = 1000.0;
constexpr double kLeastCharger_W = 5.0;  ///< less charges no robot

template <class Named>
const std::string& known_name(const Node& node, const Named& names, const char* kind) {
  for (const auto& name : names)
    if (name == node.text()) return node.text();
  const std::string near = nearest_word(node.text(), {names.begin(), names.end()});
  node.fail(std::string("one of the ") + kind + ": " + text_of_list(names),
            near.empty() ? "" : "did you mean " + near + "?");
}

/// The names of a fleet's items, each once.
class Names {
 public:
  const std::string& once(const Node& name, const char* item) {
    if (!names_.insert(name.text()).second) name.fail(std::string("a name that no other ") + item + " has");
    return name.text();
  }

 private:
  std::set<std::string> names_{};
};

double end_after(const Node& item, const char* end_key, double begin_s, const char* begin_key) {
  const auto end = item.find(end_key);
  if (!end) return std::numeric_limits<double>::infinity();
  if (end->number() <= begin_s) end->fail(std::string("a number > ") + begin_key);
  return end->number();
}

MissionRequest floor_from(const Node& root, const ReadOptions& options) {
  const auto file_named = [&](const char* key) {
    const auto node = root.find(key);
    return node ? resolve_file(*node, options) : std::string();
  };
  MissionRequest floor{.map_file = file_named("map"),
                       .unknown_is_floor = root.text_or("unknown", "occupied") == "free",
                       .keepout_file = file_named("keepout"),
                       .route_graph_file = file_named("route_graph"),
                       .clearance_m = root.number_or("clearance_m", 0.0),
                       .marks = marks_of(root)};
  if (const auto mask = root.find("speed_mask"))
    floor.speed_mask = {
        resolve_file((*mask)["file"], options),
        mask->text_or("kind", "percent") == "absolute" ? SpeedMask::Kind::absolute : SpeedMask::Kind::percent,
        mask->number_or("base", 100.0), mask->number_or("multiplier", -1.0)};
  for (const auto& [name, place] : root["stations"].entries())
    floor.stations[name] = {.x_m = place["x_m"].number(),
                            .y_m = place["y_m"].number(),
                            .heading_rad = place.optional_number("heading_rad"),
                            .marks = marks_of(place)};
  return floor;
}

class FleetReader {
 public:
  FleetReader(const Document& document, const ReadOptions& options)
      : options_(options), fleet_{.file = document.file()} {
    for (const auto& [name, place] : document.root()["stations"].entries()) stations_.push_back(name);
  }

  Fleet read(const Node& root) && {
    fleet_.name = root.text_or("name", printable(std::filesystem::path(fleet_.file).stem().string()));
    fleet_.marks = marks_of(root);
    fleet_.floor = floor_from(root, options_);
    fleet_.energy_margin = root.optional_number("energy_margin");
    fleet_.payload_band_kg = root.number_or("payload_band_kg", kDefaultBand_kg);
    for (const Node& item : root["robots"].items()) add_robot(item);
    if (const auto chargers = root.find("chargers"))
      for (const Node& item : chargers->items()) add_charger(item);
    for (const Node& item : root["missions"].items()) add_mission(item);
    return std::move(fleet_);
  }

 private:
  const std::string& station(const Node& node) const { return known_name(node, stations_, "stations"); }

  void add_robot(const Node& item) {
    FleetRobot robot{.name = robots_.once(item["name"], "robot"),
                     .robot_file = resolve_file(item["robot"], options_),
                     .start = station(item["start"]),
                     .battery_fraction = item.number_or("battery_fraction", 1.0),
                     .from_s = item.number_or("from_s", 0.0),
                     .use_price_J = item.number_or("use_price_J", 0.0),
                     .marks = marks_of(item)};
    robot.to_s = end_after(item, "to_s", robot.from_s, "from_s");
    robot_names_.push_back(robot.name);
    fleet_.robots.push_back(std::move(robot));
  }

  void add_charger(const Node& item) {
    FleetCharger charger{.station = station(item["station"]),
                         .count = static_cast<int>(item.number_or("count", 1.0)),
                         .power_W = item["power_W"].number(),
                         .knee_fraction = item.number_or("knee_fraction", 1.0),
                         .marks = marks_of(item)};
    chargers_.once(item["station"], "charger");
    if (item.has("knee_fraction") != item.has("taper_W"))
      item.fail("knee_fraction and taper_W, or neither", "they are the second piece of the charge curve");
    charger.taper_W = item.number_or("taper_W", charger.power_W);
    if (charger.taper_W > charger.power_W)
      item["taper_W"].fail("a number <= power_W", charger.power_W < kLeastCharger_W
                                                      ? item.path_of("power_W") + " is " +
                                                            item["power_W"].text() + " W: is it in kW?"
                                                      : "");
    fleet_.chargers.push_back(std::move(charger));
  }

  void add_mission(const Node& item) {
    FleetMission mission{.name = missions_.once(item["name"], "mission"),
                         .ready_s = item.number_or("ready_s", 0.0),
                         .late_price_W = item.number_or("late_price_W", kDefaultLatePrice_W),
                         .marks = marks_of(item)};
    mission.due_s = end_after(item, "due_s", mission.ready_s, "ready_s");
    for (const Node& stop : item["stops"].items())
      mission.stops.push_back({.station = station(stop["station"]),
                               .payload_kg = stop.number_or("payload_kg", 0.0),
                               .dwell_s = stop.number_or("dwell_s", 0.0),
                               .marks = marks_of(stop)});
    if (mission.stops.back().payload_kg > 0)
      item["stops"].items().back()["payload_kg"].fail("0 at the last stop",
                                                      "a mission ends without a payload");
    if (const auto robots = item.find("robots"))
      for (const Node& robot : robots->items())
        mission.robots.push_back(known_name(robot, robot_names_, "robots"));
    fleet_.missions.push_back(std::move(mission));
  }

  ReadOptions options_;
  Fleet fleet_;
  std::vector<std::string> stations_{};
  std::vector<std::string> robot_names_{};
  Names robots_{}, chargers_{}, missions_{};
};

}  // namespace

Schema fleet_schema() {
  Schema schema = schema_in(embedded::fleet_schemas, "fleet", false);
  for (Schema::Key& key : mission_schema().keys) {
    const bool is_needed = key.name == "map" || key.name == "stations";
    if (!is_needed && key.name != "unknown" && key.name != "keepout" && key.name != "speed_mask" &&
        key.name != "route_graph" && key.name != "clearance_m")
      continue;
    key.required = is_needed;
    schema.keys.push_back(std::move(key));
  }
  return with_physical_bounds(std::move(schema));
}

Fleet fleet_from(const Document& document, const ReadOptions& options) {
  static const Schema schema = fleet_schema();
  check_document(document, "fleet", schema);
  return FleetReader(document, options).read(document.root());
}

Fleet read_fleet(const std::string& file, const ReadOptions& options) {
  return fleet_from(Document::load(file), options);
}

std::vector<std::string> fleet_notes(const Fleet& fleet) {
  std::vector<std::string> notes;
  for (const FleetCharger& charger : fleet.chargers)
    if (charger.power_W < kLeastCharger_W)
      notes.push_back(charger.marks.key_path("power_W") + ": " + four_digits(charger.power_W) +
                      " W charge no robot; is it in kW?");
  double least_s = std::numeric_limits<double>::infinity();
  for (const FleetMission& mission : fleet.missions) {
    double stands_s = 0.0;
    for (const FleetStop& stop : mission.stops) stands_s += stop.dwell_s;
    least_s = std::min(least_s, stands_s);
  }
  for (const FleetRobot& robot : fleet.robots)
    if (robot.to_s - robot.from_s < least_s)
      notes.push_back(robot.marks.key_path("to_s") + ": a shift of " +
                      four_digits(robot.to_s - robot.from_s) +
                      " s is shorter than the dwell of every mission (" + four_digits(least_s) +
                      " s or more); is it in hours?");
  return notes;
}

}  // namespace joulepath
