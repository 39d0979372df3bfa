#include "planner/mission/visit_verdict.hpp"

#include <cstdio>

#include "model/limit_table.hpp"

namespace joulepath {
namespace {

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", value);
  return text;
}

/// The verdict of a stop whose window prevents an order.
Infeasibility at_stop(const MissionRequest& mission, std::size_t visit, std::string constraint) {
  const Station& place = mission.stations.at(mission.visit[visit].station);
  return {.constraint = std::move(constraint), .x_m = place.x_m, .y_m = place.y_m};
}

Infeasibility too_heavy(const MissionRequest& mission, double heaviest_kg, double capacity_kg) {
  const Limit& row = payload_limit();
  Infeasibility reason = at_stop(mission, 0, "visit_order");
  reason.amount = heaviest_kg - capacity_kg;
  reason.unit = std::string(row.unit);
  reason.relaxation = {{std::string(row.key), heaviest_kg}};
  char text[160];
  std::snprintf(text, sizeof text, "in every order the robot carries %.6g kg at once, more than %s = %.6g",
                heaviest_kg, std::string(row.key).c_str(), capacity_kg);
  reason.message = text;
  return reason;
}

}  // namespace

Infeasibility missed_window(const MissionRequest& mission, std::size_t visit, double late_s,
                            int planned_orders) {
  const auto& [earliest_s, latest_s] = *mission.visit[visit].window_s;
  Infeasibility reason = at_stop(mission, visit, "visit_order");
  reason.amount = late_s;
  reason.unit = "s";
  reason.relaxation = {{"window_s", latest_s + late_s}};
  reason.message = "no order of the stops that was planned (" + std::to_string(planned_orders) +
                   ") keeps its windows; the best reaches '" + mission.visit[visit].station + "' (visit[" +
                   std::to_string(visit) + "]) " + seconds(late_s) + " after its window of " +
                   seconds(earliest_s) + " to " + seconds(latest_s);
  return reason;
}

Infeasibility no_order(const MissionRequest& mission, const Robot& robot, const VisitSearch& search) {
  if (const auto stop = search.unreachable()) {
    Infeasibility reason = at_stop(mission, *stop, "path");
    reason.unit = "m";
    reason.message = "'" + mission.visit[*stop].station + "' cannot be reached";
    return reason;
  }
  if (const auto labels = search.orders({.capacity = true}); !labels.empty())
    return too_heavy(mission, labels.front().heaviest_kg, payload_limit_kg(robot));
  Infeasibility reason = at_stop(mission, 0, "visit_order");
  reason.message =
      "no order of the stops keeps the time windows, the capacity and picks before their drops: more than "
      "one of them prevents it";
  return reason;
}

}  // namespace joulepath
