#include "planner/mission/visit_table.hpp"

#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"
#include "model/progress.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {
namespace {

/// Prices (W) above the mission's at which legs are measured if windows need faster drives.
constexpr std::array<double, 6> kPrices_W{kNoLimit, 100, 30, 10, 3, 1};

/// A leg that no plan had, relative to the least share of its estimate that a planned leg cost. Shares are
/// 0.5 to 0.95 between named headings, most alike within a mission, and 0.85 to 1.05 else.
constexpr double kBelowLeast = 0.9;
constexpr double kLeastLeg_J = 1e-6;

double interpolate(const std::array<double, 3>& at, double fraction) {  // nodes 0, 1/2, 1
  return at[0] * (1 - fraction) * (1 - 2 * fraction) + at[1] * 4 * fraction * (1 - fraction) +
         at[2] * fraction * (2 * fraction - 1);
}

/// The robot never carries more than its limit, or more than all picks together.
double heaviest_kg(const ChoiceContext& context) {
  double picked_kg = 0.0;
  for (const VisitRequest& visit : context.mission.visit)
    if (visit.kind == VisitRequest::Kind::pick) picked_kg += visit.payload_kg;
  return std::min(payload_limit_kg(context.world.robot), picked_kg);
}

/// Without windows the cheapest drive is enough.
std::vector<double> prices_W(const ChoiceContext& context) {
  std::vector<double> prices_W;
  if (has_windows(context.mission))
    for (double price_W : kPrices_W)
      if (price_W > context.price_W) prices_W.push_back(price_W);
  prices_W.push_back(context.price_W);
  return prices_W;
}

LegStart start_of(const MissionRequest& mission, std::size_t from) {
  if (from == mission.visit.size())
    return {.pose = mission.start.pose, .heading_free = !mission.start.heading_given};
  const Station& station = mission.stations.at(mission.visit[from].station);
  return {.pose = {station.x_m, station.y_m, station.heading_rad.value_or(0.0)},
          .heading_free = !station.heading_rad};
}

/// The lattice alone: the table needs energies within percents, and there are many pairs.
RouteResult quick_route(const RouteSpace& space, const RouteRequest& request) {
  if (auto verdict = no_way(space, request)) return {.verdict = std::move(*verdict)};
  if (is_there_already(request)) return shape_route(space, request, {});
  const auto routes = pool_routes(space, request, {.classes = 1, .searches = 0});
  return routes.empty() ? plan_route(space, request) : shape_route(space, request, routes.front().polyline_m);
}

}  // namespace

bool has_windows(const MissionRequest& mission) {
  return std::any_of(mission.visit.begin(), mission.visit.end(),
                     [](const VisitRequest& visit) { return visit.window_s.has_value(); });
}

VisitTable::VisitTable(const ChoiceContext& context)
    : count_(context.mission.visit.size()),
      price_W_(context.finite_price_W()),
      heaviest_kg_(heaviest_kg(context)),
      table_((count_ + 1) * count_) {
  expect_steps(count_ * count_);
  for (std::size_t from = 0; from <= count_; ++from)
    for (std::size_t to = 0; to < count_; ++to) {
      if (from == to) continue;
      table_[from * count_ + to] = measure(context, from, to);
      finish_steps();
    }
}

VisitTable::LegCost VisitTable::measure(const ChoiceContext& context, std::size_t from,
                                        std::size_t to) const {
  const VisitRequest& visit = context.mission.visit[to];
  LegRequest leg{.to = visit.station, .marks = visit.marks};
  const RouteResult route = quick_route(
      *context.space, route_request(leg, start_of(context.mission, from), context.mission, context.options));
  LegCost result{.reachable = route.found()};
  for (const double price_W : prices_W(context)) {
    if (!result.reachable) break;
    ChoiceContext priced = context;
    priced.price_W = price_W;
    Drive drive;
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

TimeFront VisitTable::estimate(std::size_t from, std::size_t to, double payload_kg, double factor) const {
  const double fraction = heaviest_kg_ > 0 ? payload_kg / heaviest_kg_ : 0.0;
  std::vector<TimeFront::Point> points;
  for (const Drive& drive : cost(from, to).drives) {
    const double time_s = interpolate(drive.duration_s, fraction);
    points.push_back({time_s, factor * (interpolate(drive.energy_J, fraction) + price_W_ * time_s)});
  }
  return TimeFront::below(std::move(points));
}

TimeFront VisitTable::front(std::size_t from, std::size_t to, double payload_kg) const {
  return estimate(from, to, payload_kg, cost(from, to).factor.value_or(rest_));
}

void VisitTable::learn(std::size_t from, std::size_t to, double payload_kg, double planned_J) {
  const double estimate_J = estimate(from, to, payload_kg, 1).least_J();
  if (!(estimate_J > kLeastLeg_J) || !(planned_J > kLeastLeg_J)) return;  // the robot is there already
  const double factor = planned_J / estimate_J;
  table_[from * count_ + to].factor = factor;
  rest_ = std::min(rest_, kBelowLeast * factor);
}

}  // namespace joulepath
