#include <algorithm>

#include "extensions/fleet/fleet_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"

namespace joulepath {
namespace {

constexpr Range kAboveFraction{0.0, 1.0, true};

Schema fleet_robot_schema() {
  return map({required("name", text()), required("robot", text(), "robot file"),
              required("start", text(), "station at which the robot starts"),
              optional("battery_fraction", number(kFraction), "at the start; default 1"),
              optional("from_s", number(kNotNegative), "available from; default 0"),
              optional("to_s", number(kPositive), "available to; default: no end"),
              optional("use_price_J", number(kNotNegative), "price of its use, in joules; default 0")});
}

Schema fleet_charger_schema() {
  return map({required("station", text()),
              optional("count", integer({1, 1000}), "robots at a time; default 1"),
              required("power_W", number(kPositive), "into the battery, below the knee"),
              optional("knee_fraction", number(kAboveFraction), "state of charge above which it tapers"),
              optional("taper_W", number(kPositive), "into the battery, above the knee")});
}

Schema fleet_mission_schema() {
  const Schema stop =
      map({required("station", text()),
           optional("payload_kg", number(kNotNegative), "on board from here to the next stop; default 0"),
           optional("dwell_s", number(kNotNegative), "after arrival")});
  return map({required("name", text()), required("stops", list(stop, 1), "in the order of driving"),
              optional("ready_s", number(kNotNegative), "earliest arrival at the first stop; default 0"),
              optional("due_s", number(kPositive), "end of the last stop; default: none"),
              optional("late_price_W", number(kNotNegative), "joules that a second late costs; default 1000"),
              optional("robots", list(text(), 1), "names of robots that may drive it; default: all")});
}

}  // namespace

Schema fleet_schema() {
  std::vector<Schema::Key> keys{
      optional("schema", text(), "joulepath/fleet/1"),
      optional("name", text()),
      optional("energy_margin", number(kFraction),
               "relative 1-sigma of the energy for robots whose file states no model_energy"),
      optional("payload_band_kg", number(kPositive), "payloads are rounded up to multiples; default 5"),
      required("robots", list(fleet_robot_schema(), 1)),
      optional("chargers", list(fleet_charger_schema())),
      required("missions", list(fleet_mission_schema(), 1))};
  for (Schema::Key& key : mission_schema().keys) {
    const bool is_needed = key.name == "map" || key.name == "stations";
    if (!is_needed && key.name != "unknown" && key.name != "keepout" && key.name != "speed_mask" &&
        key.name != "route_graph" && key.name != "clearance_m")
      continue;
    key.required = is_needed;
    keys.push_back(std::move(key));
  }
  return with_physical_bounds(map(std::move(keys)));
}

}  // namespace joulepath
