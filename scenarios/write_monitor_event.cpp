#include "scenarios/write_monitor_event.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenarios/significant.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// A number that JSON can hold.
Json finite(double value) { return std::isfinite(value) ? Json(six_digits(value)) : Json(nullptr); }

Json pair(const std::array<double, 2>& interval) {
  return Json::array({finite(interval[0]), finite(interval[1])});
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json event_json(const MonitorStatus& s) {
  Json json{{"event", "status"},
            {"time_s", s.time_s},
            {"leg", s.leg},
            {"executed_J", s.measured ? finite(s.executed_J) : Json(nullptr)},
            {"planned_J", finite(s.planned_J)},
            {"payload_kg", s.payload_kg ? finite(*s.payload_kg) : Json(nullptr)},
            {"payload_interval_95", s.payload_interval_95 ? pair(*s.payload_interval_95) : Json(nullptr)},
            {"rest_J", finite(s.rest_J)},
            {"rest_upper_95_J", finite(s.rest_upper_J)},
            {"battery_fraction", s.battery_fraction ? finite(*s.battery_fraction) : Json(nullptr)},
            {"battery_suffices", or_null(s.battery_suffices)},
            {"bridged_s", finite(s.bridged_s)}};
  json["rows"] = {
      {"used", s.rows.used}, {"late", s.rows.late}, {"broken", s.rows.broken}, {"missing", s.rows.missing}};
  return json;
}

Json event_json(const PayloadChanged& c) {
  return {{"event", "payload"},
          {"time_s", c.time_s},
          {"since_s", c.since_s},
          {"stated_kg", finite(c.stated_kg)},
          {"payload_kg", finite(c.payload_kg)},
          {"interval_95", pair(c.interval_95)}};
}

Json event_json(const NotPayload& c) {
  return {{"event", "not_payload"},
          {"time_s", c.time_s},
          {"since_s", c.since_s},
          {"resistance_percent", finite(c.resistance_percent)},
          {"interval_95", pair(c.interval_95)},
          {"looks_like", c.looks_like},
          {"reason", c.reason},
          {"next", "joulepath diagnose"}};
}

Json event_json(const LegExecuted& c) {
  return {{"event", "leg"},
          {"time_s", c.time_s},
          {"leg", c.leg},
          {"executed_J", finite(c.executed_J)},
          {"planned_J", finite(c.planned_J)},
          {"deviates", c.deviates}};
}

template <class... Values>
std::string line(const char* pattern, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string event_text(const MonitorStatus& s) {
  std::string text = line("%8.1f s  leg %zu  ", s.time_s, s.leg);
  text += s.measured ? line("%.0f J of %.0f J planned", s.executed_J, s.planned_J)
                     : line("no power measured, %.0f J planned", s.planned_J);
  if (s.payload_kg)
    text += line(", payload %.2f kg (%.2f to %.2f)", *s.payload_kg, (*s.payload_interval_95)[0],
                 (*s.payload_interval_95)[1]);
  text += line(", rest %.0f J, at most %.0f J", s.rest_J, s.rest_upper_J);
  if (s.battery_suffices)
    text += line(", battery %.1f %%: %s", 100 * *s.battery_fraction,
                 *s.battery_suffices ? "enough" : "NOT ENOUGH");
  return text;
}

std::string event_text(const PayloadChanged& c) {
  return line("%8.1f s  PAYLOAD %.2f kg (%.2f to %.2f) since %.1f s, stated %.2f kg", c.time_s, c.payload_kg,
              c.interval_95[0], c.interval_95[1], c.since_s, c.stated_kg);
}

std::string event_text(const NotPayload& c) {
  return line("%8.1f s  NOT PAYLOAD since %.1f s: %s (%+.0f %% of the dry friction%s%s); diagnose the log",
              c.time_s, c.since_s, c.reason.c_str(), c.resistance_percent,
              c.looks_like.empty() ? "" : ", looks like ", c.looks_like.c_str());
}

std::string event_text(const LegExecuted& c) {
  return line("%8.1f s  leg %zu done: %.0f J, planned %.0f J%s", c.time_s, c.leg, c.executed_J, c.planned_J,
              c.deviates ? ": DEVIATES" : "");
}

}  // namespace

std::string monitor_json(const MonitorEvent& event) {
  Json json{{"schema", "joulepath/monitor/1"}};
  json.update(std::visit([](const auto& e) { return event_json(e); }, event));
  return json.dump();
}

std::string monitor_text(const MonitorEvent& event) {
  return std::visit([](const auto& e) { return event_text(e); }, event);
}

}  // namespace joulepath
