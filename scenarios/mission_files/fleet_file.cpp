#include "scenarios/mission_files/fleet_file.hpp"

#include <set>

#include "scenarios/document_kind.hpp"
#include "scenarios/mission_files/mission_file.hpp"

namespace joulepath {

Schema fleet_schema() {
  const Schema robot = map({required("name", text()), required("robot", text(), "robot file"),
                            optional("start", text(), "station at which the robot starts"),
                            optional("battery_fraction", number(kFraction))});
  const Schema charger = map({required("station", text()), optional("count", integer({1, 10000})),
                              required("power_W", number(kPositive))});
  return map({optional("schema", text(), "joulepath/fleet/1"), required("robots", list(robot, 1)),
              optional("chargers", list(charger)), required("missions", list(text(), 1), "mission files")});
}

Fleet read_fleet(const std::string& file, const ReadOptions& options) {
  const Document document = Document::load(file);
  check_document(document, "fleet", fleet_schema());
  const Node root = document.root();
  Fleet fleet{.file = file};
  std::set<std::string> names;
  for (const auto& item : root["robots"].items()) {
    if (!names.insert(item["name"].text()).second) item["name"].fail("a name that no other robot has");
    fleet.robots.push_back({.name = item["name"].text(),
                            .robot_file = resolve_file(item["robot"], options),
                            .start = item.text_or("start", ""),
                            .battery_fraction = item.optional_number("battery_fraction"),
                            .marks = marks_of(item)});
  }
  if (const auto chargers = root.find("chargers"))
    for (const auto& item : chargers->items())
      fleet.chargers.push_back({.station = item["station"].text(),
                                .count = static_cast<int>(item.number_or("count", 1.0)),
                                .power_W = item["power_W"].number(),
                                .marks = marks_of(item)});
  for (const auto& mission : root["missions"].items()) {
    fleet.mission_files.push_back(resolve_file(mission, options));
    fleet.mission_marks.push_back({.path = mission.path(), .item = mission.mark()});
  }
  return fleet;
}

}  // namespace joulepath
