#include "extensions/fleet/route_driver.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

// Design: docs/decisions/0701-python.md
namespace joulepath {
namespace {

using Drive = RoutingProblem::Drive;
using Drives = RoutingProblem::Drives;

std::int64_t need(const Drive& way, std::int64_t standby) { return way.upper + standby * way.duration_s; }

/// a / b + c / d, rounded up.
std::int64_t rounded_up(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  return a / b + c / d + (a % b * d + c % d * b + b * d - 1) / (b * d);
}

/// The cheapest speed that is not late, else the quickest.
template <class Late>
int late_choice(const Drives& drives, const Late& late_s) {
  const auto found =
      std::find_if(drives.begin(), drives.end(), [&](const Drive& d) { return late_s(d) <= 0; });
  return static_cast<int>(std::min(found, drives.end() - 1) - drives.begin());
}

const Drive& at(const Drives& drives, int speed) { return drives[static_cast<std::size_t>(speed)]; }

std::int64_t route_cost(const RoutingProblem& problem, int r, const std::vector<RouteStep>& route) {
  if (route.empty()) return 0;
  const auto& robot = problem.robot(r);
  int place = robot.start;
  std::int64_t cost = robot.use_price, end_s = 0;
  for (const RouteStep& step : route) {
    const auto& mission = problem.mission(step.mission);
    if (step.visit) {
      const int dock = problem.charger(step.visit->charger).place;
      cost += problem.way(robot.type, place, dock).front().motion;
      place = dock;
    }
    const Drive& speed = at(problem.drives(step.mission, robot.type), step.speed);
    cost += at(problem.way(robot.type, place, mission.first), step.way).motion + speed.motion;
    end_s = step.start_s + speed.duration_s;
    cost += mission.late_price * std::max<std::int64_t>(0, end_s - mission.due_s);
    place = mission.last;
  }
  return cost + problem.type_of(r).standby * (end_s - robot.from_s);
}

}  // namespace

std::int64_t routes_cost(const RoutingProblem& problem, const Routes& routes) {
  std::int64_t cost = 0;
  for (std::size_t r = 0; r < routes.size(); ++r) cost += route_cost(problem, static_cast<int>(r), routes[r]);
  return cost;
}

RouteDriver::RouteDriver(const RoutingProblem& problem) : problem_(problem) {
  for (std::size_t t = 0; t < problem.types.size(); ++t)
    for (int place = 0; place < problem.places; ++place) {
      std::optional<std::int64_t> least;
      for (const auto& charger : problem.chargers) {
        const Drives& way = problem.way(static_cast<int>(t), place, charger.place);
        if (way.empty()) continue;
        const std::int64_t own = need(way.front(), problem.types[t].standby);
        least = least ? std::min(*least, own) : own;
      }
      to_dock_.push_back(least.value_or(0));
    }
}

void RouteDriver::begin() {
  at_.clear();
  for (const auto& robot : problem_.robots) at_.push_back({robot.start, robot.from_s, robot.level});
  routes_.assign(problem_.robots.size(), {});
  taken_.assign(problem_.chargers.size(), {});
  for (const auto& busy : problem_.busy)
    taken_[static_cast<std::size_t>(busy.charger)].push_back({busy.from_s, busy.to_s});
}

/// The earliest begin of a visit of so many seconds.
std::int64_t RouteDriver::free_from(int charger, std::int64_t time_s, std::int64_t duration_s) const {
  const auto& taken = taken_[static_cast<std::size_t>(charger)];
  const int count = problem_.charger(charger).count;
  const auto served = [&](std::int64_t moment_s) {
    return std::count_if(taken.begin(), taken.end(),
                         [&](const Taken& x) { return x.from_s <= moment_s && moment_s < x.to_s; });
  };
  const auto fits = [&](std::int64_t begin_s) {
    if (served(begin_s) >= count) return false;
    for (const Taken& x : taken)
      if (x.from_s > begin_s && x.from_s < begin_s + duration_s && x.to_s > begin_s &&
          served(x.from_s) >= count)
        return false;
    return true;
  };
  if (fits(time_s)) return time_s;
  std::optional<std::int64_t> found;
  for (const Taken& x : taken)
    if (x.to_s > time_s && (!found || x.to_s < *found) && fits(x.to_s)) found = x.to_s;
  return *found;  // at the end of the last visit the charger is free
}

/// Whole seconds of a charge. Standby is drawn meanwhile.
std::int64_t RouteDriver::charge_s(int charger, int r, std::int64_t level, std::int64_t target) const {
  const auto& at = problem_.charger(charger);
  const std::int64_t knee = at.knees[static_cast<std::size_t>(problem_.robot(r).type)],
                     fast = at.power - type_of(r).standby, slow = at.taper - type_of(r).standby;
  const std::int64_t below = std::max<std::int64_t>(0, std::min(target, knee) - level),
                     above = std::max<std::int64_t>(0, target - std::max(level, knee));
  return rounded_up(below, fast, above, slow);
}

/// Energy that a robot needs to reach its nearest charger; 0 without chargers.
std::int64_t RouteDriver::to_dock(int r, int place) const {
  const int index = problem_.robot(r).type * problem_.places + place;
  return to_dock_[static_cast<std::size_t>(index)];
}

/// Energy for a mission from a place, waiting included.
std::int64_t RouteDriver::needed(int r, int m, int place, std::int64_t clock) const {
  const auto& mission = problem_.mission(m);
  const int type = problem_.robot(r).type;
  const Drive &way = problem_.way(type, place, mission.first).front(),
              &speed = problem_.drives(m, type).front();
  const std::int64_t end_s = std::max(clock + way.duration_s, mission.ready_s) + speed.duration_s;
  return way.upper + speed.upper + type_of(r).standby * (end_s - clock);
}

/// Energy for the rest of an order, without waiting.
std::int64_t RouteDriver::rest(int r, std::span<const int> order) const {
  const std::int64_t standby = type_of(r).standby;
  const int type = problem_.robot(r).type;
  int place = at_[static_cast<std::size_t>(r)].place;
  std::int64_t total = 0;
  for (const int m : order) {
    const auto& mission = problem_.mission(m);
    total += need(problem_.way(type, place, mission.first).front(), standby) +
             need(problem_.drives(m, type).front(), standby);
    place = mission.last;
  }
  return total * 21 / 20;
}

/// A charge after the way to the charger and the wait there; null where the battery does not last until then.
std::optional<ChargerVisit> RouteDriver::charged(int r, const Charge& charge) const {
  const At& at = at_[static_cast<std::size_t>(r)];
  const Type& type = type_of(r);
  const Drive& way =
      problem_.way(problem_.robot(r).type, at.place, problem_.charger(charge.charger).place).front();
  const std::int64_t arrival_s = at.clock + way.duration_s;
  std::int64_t begin_s = arrival_s;
  for (int tries = 0; tries < 20; ++tries) {  // a later begin needs a longer charge
    const std::int64_t level = at.level - way.upper - type.standby * (begin_s - at.clock);
    if (level < type.reserve) return {};
    const std::int64_t target = std::max(level, std::min(charge.target, type.capacity));
    const std::int64_t seconds = charge_s(charge.charger, r, level, target);
    const std::int64_t free_s = free_from(charge.charger, arrival_s, std::max<std::int64_t>(1, seconds));
    if (free_s <= begin_s) return ChargerVisit{charge.charger, begin_s, begin_s + seconds, target};
    begin_s = free_s;
  }
  return {};
}

/// Drives a robot to a mission, by a charge first; false and nothing done where its battery refuses.
bool RouteDriver::go(int r, int m, const std::optional<Charge>& charge) {
  At& here = at_[static_cast<std::size_t>(r)];
  const auto& mission = problem_.mission(m);
  const auto& robot = problem_.robot(r);
  At from = here;
  std::optional<ChargerVisit> visit;
  if (charge) {
    visit = charged(r, *charge);
    if (!visit) return false;
    from = {problem_.charger(charge->charger).place, visit->to_s, visit->target};
  }
  const Drives &ways = problem_.way(robot.type, from.place, mission.first),
               &speeds = problem_.drives(m, robot.type);
  const auto late_s = [&](const Drive& d) {
    return std::max(from.clock + d.duration_s, mission.ready_s) + speeds.front().duration_s - mission.due_s;
  };
  const int way = visit ? 0 : late_choice(ways, late_s);
  const std::int64_t start_s = std::max(from.clock + at(ways, way).duration_s, mission.ready_s);
  const int speed =
      late_choice(speeds, [&](const Drive& d) { return start_s + d.duration_s - mission.due_s; });
  const std::int64_t end_s = start_s + at(speeds, speed).duration_s;
  const std::int64_t level =
      from.level - at(ways, way).upper - at(speeds, speed).upper - type_of(r).standby * (end_s - from.clock);
  if (level < type_of(r).reserve || end_s > robot.to_s) return false;
  if (visit) taken_[static_cast<std::size_t>(visit->charger)].push_back({visit->from_s, visit->to_s});
  routes_[static_cast<std::size_t>(r)].push_back({m, way, speed, start_s, visit});
  here = {mission.last, end_s, level};
  return true;
}

/// Chargers by the time at which a visit can begin, or by the length of the way.
std::vector<int> RouteDriver::chargers_by(int r, bool by_queue) const {
  const At& here = at_[static_cast<std::size_t>(r)];
  std::vector<std::pair<std::int64_t, int>> found;
  for (int c = 0; c < static_cast<int>(problem_.chargers.size()); ++c) {
    const std::int64_t way_s =
        problem_.way(problem_.robot(r).type, here.place, problem_.charger(c).place).front().duration_s;
    found.emplace_back(by_queue ? free_from(c, here.clock + way_s, 1) : way_s, c);
  }
  std::sort(found.begin(), found.end());
  std::vector<int> chargers;
  for (const auto& [_, c] : found) chargers.push_back(c);
  return chargers;
}

bool RouteDriver::next(int r, std::span<const int> order, std::int64_t wait_s) {
  const At& here = at_[static_cast<std::size_t>(r)];
  const Type& type = type_of(r);
  const int m = order.front();
  const std::int64_t spare = here.level - type.reserve - needed(r, m, here.place, here.clock);
  const std::int64_t onward =
      order.size() > 1 ? to_dock(r, problem_.mission(m).last) + type.standby * wait_s : 0;
  if (spare >= onward && go(r, m, {})) return true;
  const std::int64_t all = rest(r, order);
  for (const int c : chargers_by(r, true)) {
    const auto& charger = problem_.charger(c);
    const std::int64_t least = type.reserve + needed(r, m, charger.place, here.clock) + onward,
                       knee = charger.knees[static_cast<std::size_t>(problem_.robot(r).type)];
    for (const std::int64_t target : {std::max(least, std::min(type.reserve + all, knee)), type.capacity})
      if (go(r, m, Charge{c, target})) return true;
  }
  return go(r, m, {});
}

std::optional<DrivenRoutes> RouteDriver::drive(const Orders& orders, std::int64_t wait_s) {
  begin();
  using Free = std::pair<std::int64_t, int>;  // from a time on, a robot
  std::priority_queue<Free, std::vector<Free>, std::greater<>> free;
  for (int r = 0; r < static_cast<int>(orders.size()); ++r)
    if (!orders[static_cast<std::size_t>(r)].empty()) free.emplace(problem_.robot(r).from_s, r);
  while (!free.empty()) {
    const auto index = static_cast<std::size_t>(free.top().second);
    const int r = free.top().second;
    free.pop();
    const std::span<const int> left = std::span(orders[index]).subspan(routes_[index].size());
    if (!next(r, left, wait_s)) return {};
    if (left.size() > 1) free.emplace(at_[index].clock, r);
  }
  return result();
}

std::optional<DrivenRoutes> RouteDriver::drive(const Orders& orders, std::span<const std::int64_t> waits_s) {
  std::optional<DrivenRoutes> best;
  for (const std::int64_t wait_s : waits_s) {
    std::optional<DrivenRoutes> found = drive(orders, wait_s);
    if (found && (!best || found->cost < best->cost)) best = std::move(found);
  }
  return best;
}

bool RouteDriver::dispatch(int r, int m, double low, double high) {
  const At& here = at_[static_cast<std::size_t>(r)];
  const Type& type = type_of(r);
  const std::int64_t after =
      here.level - needed(r, m, here.place, here.clock) - to_dock(r, problem_.mission(m).last);
  const auto capacity = static_cast<double>(type.capacity);
  if (static_cast<double>(here.level) < low * capacity || after < type.reserve)
    for (const int c : chargers_by(r, false))
      if (go(r, m, Charge{c, std::llrint(high * capacity)})) return true;
  return go(r, m, {});
}

std::optional<DrivenRoutes> RouteDriver::dispatch(double low, double high) {
  begin();
  std::vector<int> open;
  for (int m = 0; m < static_cast<int>(problem_.missions.size()); ++m) open.push_back(m);
  const auto ready_s = [this](int m) { return problem_.mission(m).ready_s; };
  std::stable_sort(open.begin(), open.end(), [&](int a, int b) { return ready_s(a) < ready_s(b); });
  for (const int m : open) {
    const auto& mission = problem_.mission(m);
    const auto free_s = [&](int r) {
      return std::max(at_[static_cast<std::size_t>(r)].clock, mission.ready_s);
    };
    const auto way_s = [&](int r) {
      return problem_.way(problem_.robot(r).type, at_[static_cast<std::size_t>(r)].place, mission.first)
          .front()
          .duration_s;
    };
    std::vector<int> robots = mission.robots;
    std::stable_sort(robots.begin(), robots.end(), [&](int a, int b) { return free_s(a) < free_s(b); });
    const auto busy =
        std::find_if(robots.begin(), robots.end(), [&](int r) { return free_s(r) > free_s(robots.front()); });
    std::stable_sort(robots.begin(), busy, [&](int a, int b) { return way_s(a) < way_s(b); });
    if (std::none_of(robots.begin(), robots.end(), [&](int r) { return dispatch(r, m, low, high); }))
      return {};
  }
  return result();
}

}  // namespace joulepath
