#include "planner/mission/visit_order.hpp"

#include <algorithm>

#include "planner/mission/visit_search.hpp"
#include "planner/mission/visit_verdict.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

/// Share of an arrival by which the table, whose routes stop at corners, may be late where a plan is not.
constexpr double kRoughTime = 0.4;

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

/// The best order within the windows first, then the others by the cost that they have without windows, those
/// that are clearly late by how late they are.
std::vector<VisitLabel> labels_to_plan(const VisitSearch& search) {
  std::vector<VisitLabel> labels = search.orders({.windows = true, .beaten = true});
  const auto rank = [](const VisitLabel& label) {
    const bool late = label.late_share > kRoughTime;
    return std::pair(late, late ? label.late_s : label.free_cost_J);
  };
  std::stable_sort(labels.begin(), labels.end(),
                   [&](const VisitLabel& a, const VisitLabel& b) { return rank(a) < rank(b); });
  if (const std::vector<VisitLabel> kept = search.orders(); !kept.empty()) {
    std::erase_if(labels, [&](const VisitLabel& label) { return label.order == kept.front().order; });
    labels.insert(labels.begin(), kept.front());
  }
  return labels;
}

}  // namespace

std::vector<OrderEstimate> order_visits(const ChoiceContext& context) {
  const MissionRequest& mission = context.mission;
  const VisitSearch search(context);
  const std::vector<VisitLabel> labels = labels_to_plan(search);
  VisitOrder result{.exact = mission.visit.size() <= kExactStops};
  if (labels.empty()) {
    result.infeasibility = no_order(mission, context.world.robot, search);
    return {{.visit = std::move(result)}};
  }
  result.given_order_J = search.given_order_J();
  result.lower_bound_J = search.lower_bound_J();
  std::vector<OrderEstimate> orders;
  for (const VisitLabel& label : labels) {
    result.order = label.order;
    result.legs = legs_of(mission, label.order);
    result.energy_J = search.energy_J(label);
    orders.push_back({result, label.free_cost_J, label.late_share > kRoughTime});
  }
  return orders;
}

}  // namespace joulepath
