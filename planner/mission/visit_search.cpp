#include "planner/mission/visit_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "model/limit_table.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
// Method: [HeldKarp1962], [DesrochersSoumis1988]
namespace joulepath {

double payload_after_kg(const VisitRequest& visit, double payload_kg) {
  switch (visit.kind) {
    case VisitRequest::Kind::pick:
      return payload_kg + visit.payload_kg;
    case VisitRequest::Kind::drop:
      return visit.payload_given ? payload_kg - visit.payload_kg : 0.0;
    default:
      return payload_kg;
  }
}

VisitSearch::VisitSearch(const ChoiceContext& context)
    : visits_(context.mission.visit),
      count_(visits_.size()),
      standby_W_(context.plant.robot.power.standby_W),
      capacity_kg_(payload_limit_kg(context.world.robot)),
      table_(context) {}

std::vector<VisitLabel> VisitSearch::orders(const RelaxedVisits& relaxed) const {
  Layer layer{{.last = count_}};
  for (std::size_t step = 0; step < count_ && !layer.empty(); ++step) layer = next_layer(layer, relaxed);
  const auto rank = [](const VisitLabel& label) { return std::pair(label.late_s, label.front.least_J()); };
  std::stable_sort(layer.begin(), layer.end(),
                   [&](const VisitLabel& a, const VisitLabel& b) { return rank(a) < rank(b); });
  return layer;
}

std::optional<double> VisitSearch::order_J(const std::vector<std::size_t>& order) const {
  std::optional<VisitLabel> label = VisitLabel{.last = count_};
  for (std::size_t k = 0; k < count_ && label; ++k)
    label = allowed(*label, order[k]) ? extend(*label, order[k], {}) : std::nullopt;
  return label ? std::optional(energy_J(*label)) : std::nullopt;
}

void VisitSearch::learn(const std::vector<std::size_t>& order, const Plan& plan) {
  if (plan.legs.size() != order.size()) return;
  std::size_t from = count_;
  double payload_kg = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const LegPlan& leg = plan.legs[k];
    const double planned_J =
        leg.energy.total_J() - standby_W_ * leg.dwell_s + table_.price_W() * leg.duration_s;
    table_.learn(from, order[k], payload_kg, planned_J);
    payload_kg = std::max(0.0, payload_after_kg(visits_[order[k]], payload_kg));
    from = order[k];
  }
}

double VisitSearch::lower_bound_J() const {
  double sum_J = 0.0;
  for (std::size_t to = 0; to < count_; ++to) {
    double least_J = kNoLimit;
    for (std::size_t from = 0; from <= count_; ++from)
      if (from != to && table_.reachable(from, to)) least_J = std::min(least_J, table_.unloaded_J(from, to));
    sum_J += least_J + standby_W_ * visits_[to].dwell_s;
  }
  return sum_J;
}

std::optional<std::size_t> VisitSearch::unreachable() const {
  for (std::size_t to = 0; to < count_; ++to)
    if (!table_.reachable(count_, to)) return to;
  return std::nullopt;
}

/// A drop waits for the picks listed before it.
bool VisitSearch::allowed(const VisitLabel& label, std::size_t next) const {
  if (label.visited >> next & 1) return false;
  if (visits_[next].kind != VisitRequest::Kind::drop) return true;
  for (std::size_t k = 0; k < next; ++k)
    if (visits_[k].kind == VisitRequest::Kind::pick && !(label.visited >> k & 1)) return false;
  return true;
}

std::optional<VisitLabel> VisitSearch::extend(const VisitLabel& label, std::size_t next,
                                              const RelaxedVisits& relaxed) const {
  if (!table_.reachable(label.last, next)) return std::nullopt;
  const VisitRequest& visit = visits_[next];
  VisitLabel after = label;
  const TimeFront leg = table_.front(label.last, next, label.payload_kg);
  after.front = label.front + leg;
  after.free_cost_J += leg.least_J() + second_J() * visit.dwell_s;
  if (visit.window_s) {
    after.front.wait_until(visit.window_s->first, second_J());
    const double late_s = after.front.soonest_s() - visit.window_s->second;
    if (late_s > 0 && !relaxed.windows) return std::nullopt;
    after.late_s = std::max(after.late_s, late_s);
    after.late_share = std::max(after.late_share, late_s / after.front.soonest_s());
    after.front.end_at(visit.window_s->second);
  }
  after.front.shift(visit.dwell_s, second_J() * visit.dwell_s);
  after.payload_kg = payload_after_kg(visit, label.payload_kg);
  const bool too_heavy = after.payload_kg > capacity_kg_ + 1e-9 && !relaxed.capacity;
  if (too_heavy || after.payload_kg < -1e-9) return std::nullopt;
  after.heaviest_kg = std::max(after.heaviest_kg, after.payload_kg);
  after.payload_kg = std::max(0.0, after.payload_kg);
  after.visited |= std::uint64_t{1} << next;
  after.last = next;
  after.order.push_back(next);
  return after;
}

/// All extensions, without those that another one with the same visits, place and payload beats in cost and
/// time.
VisitSearch::Layer VisitSearch::next_layer(const Layer& layer, const RelaxedVisits& relaxed) const {
  const bool all = relaxed.beaten && count_ <= kAllOrders;
  const auto beats = [all](const VisitLabel& a, const VisitLabel& b) {
    return !all && a.late_s <= b.late_s && a.front.is_below(b.front);
  };
  std::map<std::tuple<std::uint64_t, std::size_t, long>, Layer> best;
  for (const VisitLabel& label : layer)
    for (std::size_t next = 0; next < count_; ++next) {
      if (!allowed(label, next)) continue;
      std::optional<VisitLabel> after = extend(label, next, relaxed);
      if (!after) continue;
      Layer& rivals = best[{after->visited, after->last, std::lround(1e6 * after->payload_kg)}];
      if (std::any_of(rivals.begin(), rivals.end(),
                      [&](const VisitLabel& rival) { return beats(rival, *after); }))
        continue;
      std::erase_if(rivals, [&](const VisitLabel& rival) { return beats(*after, rival); });
      rivals.push_back(std::move(*after));
    }
  Layer kept;
  for (auto& [key, labels] : best) std::move(labels.begin(), labels.end(), std::back_inserter(kept));
  if (count_ > kExactStops && kept.size() > kBeam) {
    std::stable_sort(kept.begin(), kept.end(), [](const VisitLabel& a, const VisitLabel& b) {
      return a.front.least_J() < b.front.least_J();
    });
    kept.resize(kBeam);
  }
  return kept;
}

}  // namespace joulepath
