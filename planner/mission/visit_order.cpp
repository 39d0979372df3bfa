#include "planner/mission/visit_order.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "planner/mission/visit_search.hpp"
#include "planner/mission/visit_verdict.hpp"
#include "planner/ways/leg_path.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

/// Share of an arrival by which the table, whose routes stop at corners, may be late where a plan is not.
constexpr double kRoughTime = 0.4;
constexpr int kPlannedOrders = 24;  ///< at most: all orders of four stops
constexpr int kChargedOrders = 6;   ///< the same where each order is planned with stops at chargers
constexpr int kLateOrders = 3;      ///< at most, of those that the table calls clearly late
/// Share of a cost by which a plan within windows may be below the table.
constexpr double kTableError = 0.3;

bool is_late(const VisitLabel& label) { return label.late_share > kRoughTime; }

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
std::vector<VisitLabel> orders_to_plan(const VisitSearch& search) {
  std::vector<VisitLabel> labels = search.orders({.windows = true, .beaten = true});
  const auto rank = [](const VisitLabel& label) {
    return std::pair(is_late(label), is_late(label) ? label.late_s : label.free_cost_J);
  };
  std::stable_sort(labels.begin(), labels.end(),
                   [&](const VisitLabel& a, const VisitLabel& b) { return rank(a) < rank(b); });
  if (const std::vector<VisitLabel> kept = search.orders(); !kept.empty()) {
    std::erase_if(labels, [&](const VisitLabel& label) { return label.order == kept.front().order; });
    labels.insert(labels.begin(), kept.front());
  }
  return labels;
}

std::string_view refusal(const Plan& plan) {
  return plan.infeasibility ? std::string_view(plan.infeasibility->reason.constraint) : std::string_view{};
}

/// The cheapest plan so far, and the verdict where there is none.
class PlannedOrders {
 public:
  PlannedOrders(const MissionRequest& mission, double price_W)
      : mission_(mission),
        price_W_(price_W),
        windows_(has_windows(mission)),
        most_(mission.charging ? kChargedOrders : kPlannedOrders) {}

  /// The first order that is not planned and can be the answer; null: none.
  const VisitLabel* next(const std::vector<VisitLabel>& orders) const {
    if (tried_.size() == most_) return nullptr;
    const auto order = std::find_if(orders.begin(), orders.end(),
                                    [&](const VisitLabel& label) { return worthwhile(label); });
    return order == orders.end() ? nullptr : &*order;
  }

  void take(Plan plan, const VisitLabel& label) {
    tried_.insert(label.order);
    if (is_late(label)) ++late_;
    const double cost_J = plan.energy.total_J() + price_W_ * plan.duration_s;
    const bool driven = is_driven(plan);
    // What empties the battery is too dear, too.
    if (driven || refusal(plan) == "battery_reserve") least_J_ = std::min(least_J_, cost_J);
    std::optional<Plan>& rival = driven ? best_ : refused_;
    if (rival && !(driven ? cost_J < best_J_ : is_less_late(plan, *rival))) return;
    if (driven) best_J_ = cost_J;
    rival = std::move(plan);
  }

  Plan answer() && {
    Plan plan = *std::move(best_ ? best_ : refused_);
    plan.visit->planned_orders = static_cast<int>(tried_.size());
    blame_window(plan);
    return plan;
  }

 private:
  bool worthwhile(const VisitLabel& label) const {
    if (tried_.contains(label.order) || (is_late(label) && (best_ || late_ == kLateOrders))) return false;
    return (windows_ ? 1 - kTableError : 1) * label.free_cost_J < least_J_;
  }

  static bool is_less_late(const Plan& plan, const Plan& rival) {
    return refusal(plan) == "deadline" && refusal(rival) == "deadline" &&
           plan.infeasibility->reason.amount < rival.infeasibility->reason.amount;
  }

  /// The verdict of a stop that is late for its window names the window.
  void blame_window(Plan& plan) const {
    if (refusal(plan) != "deadline") return;
    Infeasibility& reason = plan.infeasibility->reason;
    const std::size_t visit = plan.visit->order[plan.infeasibility->leg];
    const auto& window_s = mission_.visit[visit].window_s;
    if (!window_s || mission_.objective.deadline_s.value_or(kNoLimit) < window_s->second) return;
    reason = missed_window(mission_, visit, reason.amount, static_cast<int>(tried_.size()));
    plan.message = reason.message;
  }

  const MissionRequest& mission_;
  double price_W_;
  bool windows_;
  std::size_t most_;
  std::set<std::vector<std::size_t>> tried_{};
  int late_{};
  double least_J_{kNoLimit};  ///< cost of an order that the answer need not exceed
  double best_J_{kNoLimit};
  std::optional<Plan> best_{}, refused_{};
};

}  // namespace

Plan plan_visits(const ChoiceContext& context, const PlanLegs& plan_legs) {
  const MissionRequest& asked = context.mission;
  const VisitSearch estimates(context);
  VisitSearch search = estimates;
  std::vector<VisitLabel> orders = orders_to_plan(search);
  VisitOrder visit{.exact = asked.visit.size() <= kExactStops};
  if (orders.empty()) {
    if (context.space)
      refuse_blocked_start(
          asked, *context.space,
          route_request({.to = asked.visit.front().station}, {asked.start.pose, !asked.start.heading_given},
                        asked, context.options));
    visit.infeasibility = no_order(asked, context.world.robot, search);
    Plan none;
    none.visit = std::move(visit);
    return none;
  }
  std::vector<std::size_t> as_listed(asked.visit.size());
  std::iota(as_listed.begin(), as_listed.end(), 0);
  visit.given_order_J = estimates.order_J(as_listed);
  visit.lower_bound_J = estimates.lower_bound_J();
  const bool learns = !has_windows(asked);
  PlannedOrders planned(asked, context.finite_price_W());
  MissionRequest mission = asked;
  while (const VisitLabel* next = planned.next(orders)) {
    const VisitLabel label = *next;
    visit.order = label.order;
    visit.legs = mission.legs = legs_of(asked, label.order);
    visit.energy_J = estimates.order_J(label.order).value_or(estimates.energy_J(label));
    Plan plan = plan_legs(mission);
    if (learns) {
      search.learn(label.order, plan);
      orders = orders_to_plan(search);
    }
    plan.visit = visit;
    planned.take(std::move(plan), label);
  }
  return std::move(planned).answer();
}

}  // namespace joulepath
