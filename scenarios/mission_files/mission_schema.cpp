#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/motion_entry.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"

namespace joulepath {
namespace {

Schema payload_schema() {
  return any_of({number(kNotNegative),
                 map({required("from", number(kNotNegative)), required("to", number(kNotNegative))})});
}

Schema leg_path_schema() {
  return map({required("bezier_m", bezier_schema(), "chain of cubic Bezier curves, four control points each"),
              optional("frame", choice({"start", "map"}),
                       "start (default): in the robot's frame where the leg begins")});
}

Schema leg_schema() {
  return map({optional("to", text(), "name of a station"), optional("path", leg_path_schema()),
              optional("motion", motion_schema(), "prescribed, not optimized"),
              optional("payload_kg", payload_schema(),
                       "on board during the leg: a number, or {from: , to: } linear in arc length"),
              optional("dwell_s", number(kNotNegative), "after arrival"),
              optional("deadline_s", number(kPositive),
                       "arrival at the leg's end, counted from the mission's start"),
              optional("duration_s", number(kPositive), "of this leg alone, without dwell"),
              optional("direction", choice({"any", "forward", "reverse"}),
                       "of a leg to a station; any (default): in reverse too, where the robot file has "
                       "limits.reverse_speed_m_s"),
              optional("start_speed_m_s", number(kNotNegative)),
              optional("end_speed_m_s", number(kNotNegative))})
      .with_exactly_one({"to", "path", "motion"});
}

Schema visit_schema() {
  return map({optional("pick", text(), "station where payload is taken on"),
              optional("drop", text(), "station where payload is set down"),
              optional("go", text(), "station to pass without change of payload"),
              optional("payload_kg", number(kNotNegative)),
              optional("window_s", list(number(kNotNegative), 2, 2), "earliest and latest arrival"),
              optional("dwell_s", number(kNotNegative))})
      .with_exactly_one({"pick", "drop", "go"});
}

Schema stations_schema() {
  return dictionary(map({required("x_m", number()), required("y_m", number()),
                         optional("heading_rad", number(), "absent: any heading"),
                         optional("charger_W", number(kNotNegative), "power of a charger here")}));
}

Schema start_schema() {
  return map({optional("station", text()), optional("x_m", number()), optional("y_m", number()),
              optional("heading_rad", number()), optional("battery_fraction", number(kFraction))})
      .with_exactly_one({"station", "x_m"});
}

Schema speed_zones_schema() {
  return list(
      map({required("leg", integer(kNotNegative), "counted from 0"), required("from_m", number(kNotNegative)),
           required("to_m", number(kPositive)), required("speed_m_s", number(kPositive))}));
}

Schema speed_mask_schema() {
  return map({required("file", text()),
              optional("kind", choice({"percent", "absolute"}), "of the robot's limit, or m/s"),
              optional("base", number(), "default 100"), optional("multiplier", number(), "default -1")});
}

Schema charging_schema() {
  return map(
      {optional("stations", list(text(), 1), "stations for charging; default: all with charger_W"),
       optional("to_fraction", number(kFraction), "state of charge at which the robot leaves; default 0.8")});
}

Schema objective_schema() {
  return map(
      {optional("minimize", choice({"energy", "time", "energy_and_time"})),
       optional("deadline_s", number(kPositive)),
       optional("time_value_W", number(kNotNegative), "value of a second in watts, with energy_and_time"),
       optional("confidence", number({kLeastConfidence, kGreatestConfidence}),
                "probability with which deadlines, reserve and limits are kept together")});
}

}  // namespace

Schema mission_schema() {
  return with_physical_bounds(
      map({optional("schema", text(), "joulepath/mission/1"), optional("name", text()),
           required("robot", text(), "robot file"),
           optional("map", text(), "Nav2 map file; needed where a leg goes to a station"),
           optional("unknown", choice({"occupied", "free"}), "unknown cells of the map; default occupied"),
           optional("keepout", text(), "Nav2 keep-out mask"),
           optional("speed_mask", speed_mask_schema(), "Nav2 speed mask"),
           optional("route_graph", text(), "Nav2 route graph (GeoJSON)"),
           optional("clearance_m", number(kNotNegative), "kept between footprint and obstacles; default 0"),
           optional("speed_zones", speed_zones_schema()), optional("stations", stations_schema()),
           optional("start", start_schema(), "default: the map's origin of coordinates, heading 0"),
           optional("legs", list(leg_schema())),
           optional("visit", list(visit_schema()), "instead of legs: the planner chooses the order"),
           optional("order", text(), "instead of legs: a VDA 5050 order (JSON)"),
           optional("payload_by_action", dictionary(number(kNotNegative)),
                    "with an order: kg that an action loads; `drop` unloads its value, or everything"),
           optional("dwell_by_action_s", dictionary(number(kNotNegative)),
                    "with an order: how long an action takes; its own parameter `duration` has precedence"),
           optional("charging", charging_schema(),
                    "allows charging stops, inserted where the mission would reach the battery's reserve"),
           optional("objective", objective_schema())}));
}

}  // namespace joulepath
