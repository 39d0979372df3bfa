#include "extensions/onboard/write_monitor_event.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenarios/text/significant.hpp"

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
            {"rest_upper_95_J", s.rest_upper_J ? finite(*s.rest_upper_J) : Json(nullptr)},
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
          {"finished", c.finished},
          {"deviates", c.deviates}};
}

template <class... Values>
std::string line(const char* pattern, Values... values) {
  char text[600];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string event_text(const MonitorStatus& s) {
  std::string text = line("%8.1f s  leg %zu: ", s.time_s, s.leg + 1);
  text += s.measured ? line("%.0f J used, %.0f J planned to here", s.executed_J, s.planned_J)
                     : line("no power measured, %.0f J planned to here", s.planned_J);
  if (s.payload_kg)
    text += line("; payload %.2f kg (95 %%: %.2f to %.2f)", *s.payload_kg, (*s.payload_interval_95)[0],
                 (*s.payload_interval_95)[1]);
  text += line("; %.0f J to go", s.rest_J);
  if (s.rest_upper_J) text += line(", at most %.0f J (95 %%)", *s.rest_upper_J);
  if (s.battery_suffices)
    text += line("; battery %.1f %%, %s", 100 * *s.battery_fraction,
                 *s.battery_suffices ? "enough" : "NOT ENOUGH to arrive above the reserve");
  return text;
}

std::string event_text(const PayloadChanged& c) {
  return line("%8.1f s  PAYLOAD is %.2f kg (95 %%: %.2f to %.2f) since %.1f s, not the stated %.2f kg",
              c.time_s, c.payload_kg, c.interval_95[0], c.interval_95[1], c.since_s, c.stated_kg);
}

std::string event_text(const NotPayload& c) {
  return line(
      "%8.1f s  NOT PAYLOAD, another cause since %.1f s: %s; resistance %+.0f %% of the nominal dry "
      "friction (95 %%: %+.0f to %+.0f)%s%s. Next: joulepath diagnose with this log",
      c.time_s, c.since_s, c.reason.c_str(), c.resistance_percent, c.interval_95[0], c.interval_95[1],
      c.looks_like.empty() ? "" : "; most like the effect ", c.looks_like.c_str());
}

std::string event_text(const LegExecuted& c) {
  return line("%8.1f s  leg %zu %s: %.0f J used, %.0f J planned%s%s", c.time_s, c.leg + 1,
              c.finished ? "finished" : "unfinished", c.executed_J, c.planned_J, c.finished ? "" : " to here",
              !c.deviates                  ? ""
              : c.executed_J > c.planned_J ? ": DEVIATES, more than planned"
                                           : ": DEVIATES, less than planned");
}

}  // namespace

std::string monitor_json(const MonitorEvent& event) {
  Json json{{"schema", "joulepath/monitor/1"}};
  json.update(std::visit([](const auto& e) { return event_json(e); }, event));
  return json.dump();
}

std::string row_counts_text(const RowCounts& rows) {
  const auto count = [](std::uint64_t n) { return std::to_string(n); };
  std::string text = "rows: " + count(rows.used) + " used";
  if (rows.late > 0) text += ", " + count(rows.late) + " late or doubled";
  if (rows.broken > 0) text += ", " + count(rows.broken) + " without a time or a wheel speed";
  if (rows.missing > 0) text += ", " + count(rows.missing) + " missing";
  return text;
}

std::string monitor_text(const MonitorEvent& event) {
  return std::visit([](const auto& e) { return event_text(e); }, event);
}

}  // namespace joulepath
