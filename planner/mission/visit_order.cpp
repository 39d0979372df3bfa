#include "planner/mission/visit_order.hpp"

#include <algorithm>

#include "planner/mission/visit_search.hpp"
#include "planner/mission/visit_verdict.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

/// Allowed lateness of a stop in the table (share of the arrival's time): routes of the table are rough, so
/// an order with little lateness is planned exactly.
constexpr double kRough = 0.1;

std::vector<LegRequest> legs_of(const MissionRequest& mission, const std::vector<std::size_t>& order) {
  std::vector<LegRequest> legs;
  double payload_kg = 0.0;
  for (const std::size_t k : order) {
    const VisitRequest& visit = mission.visit[k];
    LegRequest leg{.to = visit.station,
                   .payload = {payload_kg, payload_kg},
                   .dwell_s = visit.dwell_s,
                   .marks = visit.marks};
    if (visit.window_s) {
      leg.earliest_s = visit.window_s->first;
      leg.deadline_s = visit.window_s->second;
    }
    legs.push_back(std::move(leg));
    payload_kg = std::max(0.0, payload_after_kg(visit, payload_kg));
  }
  return legs;
}

}  // namespace

VisitOrder order_visits(const ChoiceContext& context) {
  const MissionRequest& mission = context.mission;
  const VisitSearch search(context);
  VisitOrder result{.exact = mission.visit.size() <= kExactStops};
  std::optional<VisitLabel> best = search.best();
  if (!best) best = search.best({.late_share = kRough});  // the exact plan decides
  if (!best) {
    result.infeasibility = no_order(mission, context.world.robot, search);
    return result;
  }
  result.order = best->order;
  result.legs = legs_of(mission, best->order);
  result.energy_J = best->front.least_J();
  result.given_order_J = search.given_order_J();
  result.lower_bound_J = search.lower_bound_J();
  return result;
}

}  // namespace joulepath
