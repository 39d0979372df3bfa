#include <algorithm>
#include <cmath>

#include "planner/mission/prepared_legs.hpp"
#include "planner/mission/visit_order.hpp"
#include "planner/mission/visit_verdict.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

constexpr int kPlannedOrders = 24;   ///< at most: all orders of four stops
constexpr int kChargedOrders = 6;    ///< the same where each order is planned with stops at chargers
constexpr int kLateOrders = 3;       ///< at most, of those that the table calls clearly late
constexpr double kTableError = 0.3;  ///< share of a cost by which a plan may be below the table

bool has_windows(const MissionRequest& mission) {
  return std::any_of(mission.visit.begin(), mission.visit.end(),
                     [](const VisitRequest& visit) { return visit.window_s.has_value(); });
}

std::string_view refusal(const Plan& plan) {
  return plan.infeasibility ? std::string_view(plan.infeasibility->reason.constraint) : std::string_view{};
}

/// The cheapest plan so far, and the verdict where there is none.
class PlannedOrders {
 public:
  PlannedOrders(const MissionRequest& mission, double price_W)
      : mission_(mission), price_W_(price_W), most_(mission.charging ? kChargedOrders : kPlannedOrders) {}

  /// Whether an order can be the answer.
  bool worthwhile(const OrderEstimate& order) const {
    if (planned_ == most_ || (best_ && !has_windows(mission_))) return false;
    if (order.late && (best_ || late_ == kLateOrders)) return false;
    return (1 - kTableError) * order.free_cost_J < least_J_;
  }

  void take(Plan plan, const OrderEstimate& order) {
    ++planned_;
    if (order.late) ++late_;
    const double cost_J = plan.energy.total_J() + price_W_ * plan.duration_s;
    const bool driven = plan.status <= SolveStatus::feasible;
    // What empties the battery is too dear, too.
    if (driven || refusal(plan) == "battery_reserve") least_J_ = std::min(least_J_, cost_J);
    std::optional<Plan>& rival = driven ? best_ : refused_;
    if (rival && !(driven ? cost_J < best_J_ : is_less_late(plan, *rival))) return;
    if (driven) best_J_ = cost_J;
    rival = std::move(plan);
  }

  Plan answer() && {
    Plan plan = *std::move(best_ ? best_ : refused_);
    plan.visit->planned_orders = planned_;
    blame_window(plan);
    return plan;
  }

 private:
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
    reason = missed_window(mission_, visit, reason.amount, planned_);
    plan.message = reason.message;
  }

  const MissionRequest& mission_;
  double price_W_;
  int most_;
  int planned_{}, late_{};
  double least_J_{kNoLimit};  ///< cost of an order that the answer need not exceed
  double best_J_{kNoLimit};
  std::optional<Plan> best_{}, refused_{};
};

}  // namespace

Plan plan_visits(const MissionRequest& asked, std::vector<OrderEstimate> orders, double price_W,
                 const PlanLegs& plan_legs) {
  PlannedOrders planned(asked, price_W);
  MissionRequest mission = asked;
  for (OrderEstimate& order : orders) {
    if (!planned.worthwhile(order)) continue;
    mission.legs = order.visit.legs;
    Plan plan = plan_legs(mission);
    plan.visit = order.visit;
    planned.take(std::move(plan), order);
  }
  return std::move(planned).answer();
}

}  // namespace joulepath
