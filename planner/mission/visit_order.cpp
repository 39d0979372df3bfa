#include "planner/mission/visit_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>

#include "planner/mission/time_front.hpp"

// Design: docs/decisions/0005-order-of-visits.md
namespace joulepath {
namespace {

/// Energy and time of a leg at three payloads, at each price of time from the highest to the mission's own.
struct LegCost {
  struct Drive {
    std::array<double, 3> energy_J{};
    std::array<double, 3> duration_s{};
  };
  bool reachable{};
  std::vector<Drive> drives{};
};

/// Prices (W) above the mission's at which legs are measured where windows ask for faster drives.
constexpr std::array<double, 6> kPrices_W{kNoLimit, 100, 30, 10, 3, 1};

/// How much later than its window a stop may be in the table (share of the arrival's time) for an order still
/// to be planned: routes of the table are rough.
constexpr double kRough = 0.1;

double interpolate(const std::array<double, 3>& at, double fraction) {  // nodes 0, 1/2, 1
  return at[0] * (1 - fraction) * (1 - 2 * fraction) + at[1] * 4 * fraction * (1 - fraction) +
         at[2] * fraction * (2 * fraction - 1);
}

/// A partial order: what is visited, where the robot is, what it carries.
struct Label {
  std::uint64_t visited{};
  std::size_t last{};  ///< visit index; visits.size() = the start
  double payload_kg{};
  TimeFront front{{0.0, 0.0}};  ///< of the departure
  double heaviest_kg{};         ///< carried so far
  double late_s{};              ///< at the stop whose window is relaxed
  std::vector<std::size_t> order{};
};

/// What a search may ignore, to find the constraint that prevents an order.
struct Relaxed {
  std::optional<std::size_t> window{};  ///< the end of this stop's
  bool capacity{};
  double late_share{};  ///< of the arrival's time, at every window
};

class VisitSearch {
 public:
  explicit VisitSearch(const ChoiceContext& context)
      : context_(context), visits_(context.mission.visit), count_(visits_.size()) {
    capacity_kg_ = context.world.robot.limits ? context.world.robot.limits->max_payload_kg : kNoLimit;
    double picked_kg = 0.0;
    for (const VisitRequest& visit : visits_)
      if (visit.kind == VisitRequest::Kind::pick) picked_kg += visit.payload_kg;
    heaviest_kg_ = std::min(capacity_kg_, picked_kg);
    fill_table();
  }

  std::optional<Label> best(const Relaxed& relaxed = {}) {
    relaxed_ = relaxed;
    std::vector<Label> layer{{.last = count_}};
    for (std::size_t step = 0; step < count_ && !layer.empty(); ++step) layer = next_layer(layer);
    const auto least = std::min_element(layer.begin(), layer.end(), [](const Label& a, const Label& b) {
      return std::pair(a.late_s, a.front.least_J()) < std::pair(b.late_s, b.front.least_J());
    });
    return least == layer.end() ? std::nullopt : std::optional(*least);
  }

  double capacity_kg() const { return capacity_kg_; }

  /// Of the stops in the order in which they are listed; nothing where that breaks a window or the capacity.
  std::optional<double> given_order_J() {
    relaxed_ = {};
    std::optional<Label> label = Label{.last = count_};
    for (std::size_t k = 0; k < count_ && label; ++k)
      label = allowed(*label, k) ? extend(*label, k) : std::nullopt;
    return label ? std::optional(label->front.least_J()) : std::nullopt;
  }

  double lower_bound_J() const {
    double sum_J = 0.0;
    for (std::size_t to = 0; to < count_; ++to) {
      double least_J = kNoLimit;
      for (std::size_t from = 0; from <= count_; ++from)
        if (from != to && cost(from, to).reachable)
          least_J = std::min(least_J, cost(from, to).drives.back().energy_J[0]);
      sum_J += least_J + standby_W() * visits_[to].dwell_s;
    }
    return sum_J;
  }

  /// The first stop that cannot be reached from the start, or nothing.
  std::optional<std::size_t> unreachable() const {
    for (std::size_t to = 0; to < count_; ++to)
      if (!cost(count_, to).reachable) return to;
    return std::nullopt;
  }

 private:
  double standby_W() const { return context_.plant.robot.power.standby_W; }
  const LegCost& cost(std::size_t from, std::size_t to) const { return table_[from * count_ + to]; }

  LegStart start_of(std::size_t from) const {
    if (from == count_)
      return {.pose = context_.mission.start.pose, .heading_free = !context_.mission.start.heading_given};
    const Station& station = context_.mission.stations.at(visits_[from].station);
    return {.pose = {station.x_m, station.y_m, station.heading_rad.value_or(0.0)},
            .heading_free = !station.heading_rad};
  }

  void fill_table() {
    table_.resize((count_ + 1) * count_);
    for (std::size_t from = 0; from <= count_; ++from)
      for (std::size_t to = 0; to < count_; ++to)
        if (from != to) table_[from * count_ + to] = measure(from, to);
  }

  LegCost measure(std::size_t from, std::size_t to) const {
    LegRequest leg{.to = visits_[to].station, .marks = visits_[to].marks};
    const RouteResult route =
        quick_route(route_request(leg, start_of(from), context_.mission, context_.options));
    LegCost result{.reachable = route.found()};
    for (double price_W : prices_W()) {
      if (!result.reachable) break;
      ChoiceContext priced = context_;
      priced.price_W = price_W;
      LegCost::Drive drive;
      for (std::size_t k = 0; k < 3; ++k) {
        const double payload_kg = 0.5 * static_cast<double>(k) * heaviest_kg_;
        leg.payload = {payload_kg, payload_kg};
        const PathScore score = score_path(route.path, leg, to, priced);
        result.reachable &= score.drivable;
        drive.energy_J[k] = score.energy_J;
        drive.duration_s[k] = score.duration_s;
      }
      result.drives.push_back(drive);
    }
    return result;
  }

  /// Without a window the cheapest drive is enough.
  std::vector<double> prices_W() const {
    std::vector<double> prices_W;
    if (std::any_of(visits_.begin(), visits_.end(),
                    [](const VisitRequest& visit) { return visit.window_s.has_value(); }))
      for (double price_W : kPrices_W)
        if (price_W > context_.price_W) prices_W.push_back(price_W);
    prices_W.push_back(context_.price_W);
    return prices_W;
  }

  /// Cost of a leg over its time, at the mission's own price, for a payload.
  TimeFront front_of(const LegCost& leg, double payload_kg) const {
    const double fraction = heaviest_kg_ > 0 ? payload_kg / heaviest_kg_ : 0.0;
    const double price_W = std::isfinite(context_.price_W) ? context_.price_W : 1e6;
    std::vector<TimeFront::Point> points;
    for (const LegCost::Drive& drive : leg.drives) {
      const double time_s = interpolate(drive.duration_s, fraction);
      points.push_back({time_s, interpolate(drive.energy_J, fraction) + price_W * time_s});
    }
    return TimeFront::below(std::move(points));
  }

  /// By the lattice alone: energies of the table need percents, and there are many pairs.
  RouteResult quick_route(const RouteRequest& request) const {
    const RouteSpace& space = *context_.space;
    if (auto verdict = no_way(space, request)) return {.verdict = std::move(*verdict)};
    if (is_there_already(request)) return shape_route(space, request, {});
    const auto routes = pool_routes(space, request, {.classes = 1, .searches = 0});
    return routes.empty() ? plan_route(space, request)
                          : shape_route(space, request, routes.front().polyline_m);
  }

  /// A drop waits for the picks listed before it.
  bool allowed(const Label& label, std::size_t next) const {
    if (label.visited >> next & 1) return false;
    if (visits_[next].kind != VisitRequest::Kind::drop) return true;
    for (std::size_t k = 0; k < next; ++k)
      if (visits_[k].kind == VisitRequest::Kind::pick && !(label.visited >> k & 1)) return false;
    return true;
  }

  std::optional<Label> extend(const Label& label, std::size_t next) const {
    const LegCost& leg = cost(label.last, next);
    if (!leg.reachable) return std::nullopt;
    const VisitRequest& visit = visits_[next];
    Label after = label;
    after.front = label.front + front_of(leg, label.payload_kg);
    if (visit.window_s) {
      after.front.wait_until(visit.window_s->first, standby_W());
      const double first_s = after.front.soonest_s(), late_s = first_s - visit.window_s->second;
      if (late_s > relaxed_.late_share * first_s && relaxed_.window != next) return std::nullopt;
      after.late_s = std::max(after.late_s, late_s);
      after.front.end_at(visit.window_s->second);
    }
    after.front.shift(visit.dwell_s, standby_W() * visit.dwell_s);
    if (visit.kind == VisitRequest::Kind::pick) after.payload_kg += visit.payload_kg;
    if (visit.kind == VisitRequest::Kind::drop)
      after.payload_kg = visit.payload_given ? after.payload_kg - visit.payload_kg : 0.0;
    const bool too_heavy = after.payload_kg > capacity_kg_ + 1e-9 && !relaxed_.capacity;
    if (too_heavy || after.payload_kg < -1e-9) return std::nullopt;
    after.heaviest_kg = std::max(after.heaviest_kg, after.payload_kg);
    after.payload_kg = std::max(0.0, after.payload_kg);
    after.visited |= std::uint64_t{1} << next;
    after.last = next;
    after.order.push_back(next);
    return after;
  }

  /// All extensions that no other one with the same visits, place and payload beats in cost and time.
  std::vector<Label> next_layer(const std::vector<Label>& layer) const {
    std::map<std::tuple<std::uint64_t, std::size_t, long>, std::vector<Label>> best;
    for (const Label& label : layer)
      for (std::size_t next = 0; next < count_; ++next) {
        if (!allowed(label, next)) continue;
        std::optional<Label> after = extend(label, next);
        if (!after) continue;
        std::vector<Label>& rivals =
            best[{after->visited, after->last, std::lround(1e6 * after->payload_kg)}];
        const auto beats = [](const Label& a, const Label& b) {
          return a.late_s <= b.late_s && a.front.is_below(b.front);
        };
        if (std::any_of(rivals.begin(), rivals.end(),
                        [&](const Label& rival) { return beats(rival, *after); }))
          continue;
        std::erase_if(rivals, [&](const Label& rival) { return beats(*after, rival); });
        rivals.push_back(std::move(*after));
      }
    std::vector<Label> all;
    for (auto& [key, labels] : best) std::move(labels.begin(), labels.end(), std::back_inserter(all));
    if (count_ > kExactStops && all.size() > kBeam) {
      std::stable_sort(all.begin(), all.end(),
                       [](const Label& a, const Label& b) { return a.front.least_J() < b.front.least_J(); });
      all.resize(kBeam);
    }
    return all;
  }

  const ChoiceContext& context_;
  const std::vector<VisitRequest>& visits_;
  std::size_t count_;
  double capacity_kg_{};
  double heaviest_kg_{};
  std::vector<LegCost> table_{};
  Relaxed relaxed_{};
};

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

Infeasibility window_missed(const MissionRequest& mission, std::size_t visit, double late_s) {
  const auto& [earliest_s, latest_s] = *mission.visit[visit].window_s;
  Infeasibility reason = at_stop(mission, visit, "visit_order");
  reason.amount = late_s;
  reason.unit = "s";
  reason.relaxation = {{"window_s", latest_s + late_s}};
  reason.message = "no order of the stops reaches '" + mission.visit[visit].station + "' (visit[" +
                   std::to_string(visit) + "]) within its window of " + seconds(earliest_s) + " to " +
                   seconds(latest_s) + "; the best arrives " + seconds(late_s) + " too late";
  return reason;
}

Infeasibility too_heavy(const MissionRequest& mission, double heaviest_kg, double capacity_kg) {
  Infeasibility reason = at_stop(mission, 0, "visit_order");
  reason.amount = heaviest_kg - capacity_kg;
  reason.unit = "kg";
  reason.relaxation = {{"max_payload_kg", heaviest_kg}};
  char text[160];
  std::snprintf(text, sizeof text,
                "in every order the robot carries %.6g kg at once, more than max_payload_kg = %.6g",
                heaviest_kg, capacity_kg);
  reason.message = text;
  return reason;
}

/// Why there is no order: the first thing without which there would be one.
Infeasibility no_order(const MissionRequest& mission, VisitSearch& search) {
  if (const auto stop = search.unreachable()) {
    Infeasibility reason = at_stop(mission, *stop, "path");
    reason.unit = "m";
    reason.message = "'" + mission.visit[*stop].station + "' cannot be reached";
    return reason;
  }
  for (std::size_t k = 0; k < mission.visit.size(); ++k)
    if (mission.visit[k].window_s)
      if (const auto label = search.best({.window = k})) return window_missed(mission, k, label->late_s);
  if (const auto label = search.best({.capacity = true}))
    return too_heavy(mission, label->heaviest_kg, search.capacity_kg());
  Infeasibility reason = at_stop(mission, 0, "visit_order");
  reason.message =
      "no order of the stops keeps the time windows, the capacity and picks before their drops: more than "
      "one "
      "of them stands in the way";
  return reason;
}

}  // namespace

VisitOrder order_visits(const ChoiceContext& context) {
  const MissionRequest& mission = context.mission;
  VisitSearch search(context);
  VisitOrder result{.exact = mission.visit.size() <= kExactStops};
  std::optional<Label> best = search.best();
  if (!best) best = search.best({.late_share = kRough});  // the plan itself has the last word
  if (!best) {
    result.infeasibility = no_order(mission, search);
    return result;
  }
  result.order = best->order;
  result.energy_J = best->front.least_J();
  result.given_order_J = search.given_order_J();
  result.lower_bound_J = search.lower_bound_J();
  double payload_kg = 0.0;
  for (const std::size_t k : best->order) {
    const VisitRequest& visit = mission.visit[k];
    LegRequest leg{.to = visit.station,
                   .payload = {payload_kg, payload_kg},
                   .dwell_s = visit.dwell_s,
                   .marks = visit.marks};
    if (visit.window_s) {
      leg.earliest_s = visit.window_s->first;
      leg.deadline_s = visit.window_s->second;
    }
    result.legs.push_back(std::move(leg));
    if (visit.kind == VisitRequest::Kind::pick) payload_kg += visit.payload_kg;
    if (visit.kind == VisitRequest::Kind::drop)
      payload_kg = visit.payload_given ? std::max(0.0, payload_kg - visit.payload_kg) : 0.0;
  }
  return result;
}

}  // namespace joulepath
