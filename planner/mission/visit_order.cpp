#include "planner/mission/visit_order.hpp"

#include <algorithm>

#include "planner/mission/visit_search.hpp"
#include "planner/mission/visit_verdict.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

constexpr std::size_t kPlannedOrders = 3;  ///< at most, where windows are missed

bool has_windows(const MissionRequest& mission) {
  return std::any_of(mission.visit.begin(), mission.visit.end(),
                     [](const VisitRequest& visit) { return visit.window_s.has_value(); });
}

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

std::vector<VisitOrder> order_visits(const ChoiceContext& context) {
  const MissionRequest& mission = context.mission;
  const VisitSearch search(context);
  std::vector<VisitLabel> labels = search.orders();
  if (has_windows(mission))
    for (VisitLabel& late : search.orders({.windows = true}))
      if (std::none_of(labels.begin(), labels.end(),
                       [&](const VisitLabel& label) { return label.order == late.order; }))
        labels.push_back(std::move(late));
  VisitOrder result{.exact = mission.visit.size() <= kExactStops};
  if (labels.empty()) {
    result.infeasibility = no_order(mission, context.world.robot, search);
    return {result};
  }
  result.given_order_J = search.given_order_J();
  result.lower_bound_J = search.lower_bound_J();
  std::vector<VisitOrder> orders(std::min(labels.size(), kPlannedOrders), result);
  for (std::size_t k = 0; k < orders.size(); ++k) {
    orders[k].order = labels[k].order;
    orders[k].legs = legs_of(mission, labels[k].order);
    orders[k].energy_J = labels[k].front.least_J();
  }
  return orders;
}

}  // namespace joulepath
