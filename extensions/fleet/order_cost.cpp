#include "extensions/fleet/order_cost.hpp"

#include <algorithm>

// Design: docs/decisions/0701-python.md
namespace joulepath {
namespace {

constexpr double kBlinkRate = 0.01;  ///< chance that a place of an order is not tried [Christiaens2020]
constexpr double kAfterShiftPrice = 10000;  ///< per second
constexpr double kNever_s = 1e7;            ///< takes a charge without a charger

double as_double(std::int64_t value) { return static_cast<double>(value); }

}  // namespace

OrderCost::OrderCost(const RoutingProblem& problem) : problem_(problem) {
  for (int r = 0; r < static_cast<int>(problem.robots.size()); ++r)
    held_.push_back(as_double(problem.robot(r).level - problem.type_of(r).reserve));
  for (const auto& type : problem.types) {
    std::int64_t most = 0;
    for (const auto& charger : problem.chargers) most = std::max(most, charger.power - type.standby);
    power_.push_back(as_double(most));
  }
}

void OrderCost::advance(int robot, int m, State& at) const {
  const auto& by = problem_.robot(robot);
  const auto& mission = problem_.mission(m);
  const auto &way = problem_.way(by.type, at.place, mission.first).front(),
             &cheapest = problem_.drives(m, by.type).front(), &quickest = problem_.drives(m, by.type).back();
  const double standby = as_double(problem_.type_of(robot).standby),
               held = held_[static_cast<std::size_t>(robot)],
               power = power_[static_cast<std::size_t>(by.type)], due_s = as_double(mission.due_s);
  double end_s = std::max(at.clock_s + as_double(way.duration_s), as_double(mission.ready_s)) +
                 as_double(cheapest.duration_s);
  at.used += as_double(way.upper + cheapest.upper) + standby * (end_s - at.clock_s);
  at.paid += as_double(way.motion + cheapest.motion);
  if (at.used > held) {
    end_s += power > 0 ? (at.used - held) / power : kNever_s;
    at.used = held;
  }
  if (end_s > due_s) {
    if (quickest.duration_s < cheapest.duration_s && mission.late_price > 0) {
      end_s -= as_double(cheapest.duration_s - quickest.duration_s);
      at.paid += as_double(quickest.motion - cheapest.motion);
    }
    at.paid += as_double(mission.late_price) * std::max(0.0, end_s - due_s);
  }
  at.paid += kAfterShiftPrice * std::max(0.0, end_s - as_double(by.to_s));
  at.place = mission.last;
  at.clock_s = end_s;
}

std::vector<OrderCost::State> OrderCost::states(int robot, std::span<const int> order) const {
  const auto& by = problem_.robot(robot);
  std::vector<State> found{{by.start, as_double(by.from_s), 0, 0}};
  for (const int m : order) {
    found.push_back(found.back());
    advance(robot, m, found.back());
  }
  return found;
}

double OrderCost::total(int robot, const std::vector<State>& states) const {
  return states.size() == 1 ? 0 : ended(robot, states.back());
}

/// The cost of an order that ends in a state.
double OrderCost::ended(int robot, const State& last) const {
  const auto& by = problem_.robot(robot);
  return as_double(by.use_price) + last.paid +
         as_double(problem_.type_of(robot).standby) * (last.clock_s - as_double(by.from_s));
}

OrderCost::Insertion OrderCost::insertion(int robot, std::span<const int> order,
                                          const std::vector<State>& states, int m, double below,
                                          Random* chance) const {
  const int type = problem_.robot(robot).type;
  const auto& mission = problem_.mission(m);
  const auto motion = [&](int from, int to) {
    return as_double(problem_.way(type, from, to).front().motion);
  };
  Insertion best{below, 0};
  for (std::size_t n = order.size() + 1; n-- > 0;) {
    if (chance != nullptr && chance->uniform() < kBlinkRate) continue;
    const int place = states[n].place;
    double own = as_double(problem_.drives(m, type).front().motion) + motion(place, mission.first);
    if (n < order.size()) {
      const int following = problem_.mission(order[n]).first;
      own += motion(mission.last, following) - motion(place, following);
    }
    if (own >= best.extra) continue;
    const double found = extra(robot, order, states, m, n, best.extra);
    if (found < best.extra) best = {found, n};
  }
  return best.extra < below ? best : Insertion{};
}

/// Ends where the rest of the order is as it was, or dearer than `below`.
double OrderCost::extra(int robot, std::span<const int> order, const std::vector<State>& states, int m,
                        std::size_t position, double below) const {
  State at = states[position];
  advance(robot, m, at);
  for (std::size_t n = position; n < order.size(); ++n) {
    advance(robot, order[n], at);
    const State& before = states[n + 1];
    if (at.paid - before.paid >= below) return kNoLimit;
    if (at.clock_s == before.clock_s)
      return at.paid - before.paid + charging(robot, states.back().used + at.used - before.used);
  }
  return ended(robot, at) - total(robot, states);
}

/// Standby while a robot charges what it uses beyond its battery.
double OrderCost::charging(int robot, double used) const {
  const double power = power_[static_cast<std::size_t>(problem_.robot(robot).type)],
               lack = used - held_[static_cast<std::size_t>(robot)];
  return power > 0 && lack > 0 ? as_double(problem_.type_of(robot).standby) * lack / power : 0.0;
}

}  // namespace joulepath
