// Laws of orders and of routes on drawn fleets; the rules of a schedule are checked here by other code.
#include "extensions/fleet/order_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace joulepath {
namespace {

struct Size {
  int robots{4}, missions{24}, chargers{2}, types{2};
  std::int64_t level{250'000};
};

RoutingProblem::Drives two_speeds(std::int64_t way_m) {
  return {{way_m + 3, 350 * way_m, 370 * way_m}, {way_m * 7 / 10 + 3, 430 * way_m, 450 * way_m}};
}

/// Places on a line; two types of robots and two speeds of each way; every fifth mission is not for one
/// robot.
RoutingProblem drawn(std::uint64_t seed, const Size& size = {}) {
  Random chance(seed);
  const auto number = [&](std::size_t low, std::size_t high) {
    return static_cast<std::int64_t>(low + chance.below(high - low));
  };
  RoutingProblem problem{.places = 8};
  std::vector<std::int64_t> at_m;
  for (int place = 0; place < problem.places; ++place) at_m.push_back(number(0, 60));
  for (int t = 0; t < size.types; ++t) problem.types.push_back({400'000, 40'000, 100 + 20 * t});
  for (int t = 0; t < size.types; ++t)
    for (const std::int64_t from : at_m)
      for (const std::int64_t to : at_m)
        problem.ways.push_back(two_speeds(std::abs(from - to) * (4 + t) / 4));
  const auto place = [&] { return static_cast<int>(number(0, 8)); };
  for (int r = 0; r < size.robots; ++r)
    problem.robots.push_back({r % size.types, place(), size.level, number(0, 60), 10'000'000, 20'000, r});
  for (int c = 0; c < size.chargers; ++c)
    problem.chargers.push_back({place(), 1 + c, 2500, 1000, {300'000, 300'000}});
  for (int m = 0; m < size.missions; ++m) {
    const std::int64_t ready_s = number(0, 500), way_m = number(5, 60);
    problem.missions.push_back({place(), place(), ready_s, ready_s + number(100, 900), 500, {}, {}});
    for (int r = 0; r < size.robots; ++r)
      if (size.robots == 1 || m % 5 != 0 || r != m % size.robots) problem.missions.back().robots.push_back(r);
    for (int t = 0; t < size.types; ++t)
      problem.missions.back().drives.push_back(two_speeds(way_m * (4 + t) / 4));
  }
  return problem;
}

/// Whole seconds in which a charge at two powers reaches a level, summed second by second.
std::int64_t seconds_to(std::int64_t target, std::int64_t level, std::int64_t knee, std::int64_t fast,
                        std::int64_t slow) {
  std::int64_t seconds = 0;
  for (auto at = static_cast<double>(level); at < static_cast<double>(target) - 1e-6; ++seconds) {
    const double left_s = (static_cast<double>(knee) - at) / static_cast<double>(fast);
    const double below_s = std::clamp(left_s, 0.0, 1.0);
    at += static_cast<double>(fast) * below_s + static_cast<double>(slow) * (1 - below_s);
  }
  return seconds;
}

struct Judged {
  const RoutingProblem& problem;
  std::vector<int> driven{};
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> visits{};
  std::int64_t cost{};

  void route(int r, const std::vector<RouteStep>& steps) {
    const auto& robot = problem.robot(r);
    const auto& type = problem.type_of(r);
    int place = robot.start;
    std::int64_t clock_s = robot.from_s, level = robot.level;
    const auto drive = [&](const RoutingProblem::Drive& by, std::int64_t until_s) {
      EXPECT_GE(until_s, clock_s + by.duration_s);
      level -= by.upper + type.standby * (until_s - clock_s);
      cost += by.motion + type.standby * (until_s - clock_s);
      clock_s = until_s;
      EXPECT_GE(level, type.reserve);
    };
    cost += steps.empty() ? 0 : robot.use_price;
    for (const RouteStep& step : steps) {
      const auto& mission = problem.mission(step.mission);
      driven.push_back(step.mission);
      EXPECT_EQ(std::count(mission.robots.begin(), mission.robots.end(), r), 1);
      if (step.visit) {
        const auto& charger = problem.charger(step.visit->charger);
        drive(problem.way(robot.type, place, charger.place).front(), step.visit->from_s);
        EXPECT_LE(step.visit->target, type.capacity);
        EXPECT_EQ(step.way, 0);
        const std::int64_t needed_s =
            seconds_to(step.visit->target, level, charger.knees[static_cast<std::size_t>(robot.type)],
                       charger.power - type.standby, charger.taper - type.standby);
        EXPECT_EQ(step.visit->to_s - step.visit->from_s, needed_s);
        visits[static_cast<std::size_t>(step.visit->charger)].emplace_back(step.visit->from_s,
                                                                           step.visit->to_s);
        place = charger.place;
        cost += type.standby * (step.visit->to_s - clock_s);
        clock_s = step.visit->to_s;
        level = step.visit->target;
      }
      const auto& way = problem.way(robot.type, place, mission.first)[static_cast<std::size_t>(step.way)];
      const auto& own = problem.drives(step.mission, robot.type)[static_cast<std::size_t>(step.speed)];
      EXPECT_GE(step.start_s, std::max(clock_s + way.duration_s, mission.ready_s));
      const std::int64_t end_s = step.start_s + own.duration_s;
      drive({way.duration_s + own.duration_s, way.motion + own.motion, way.upper + own.upper}, end_s);
      EXPECT_LE(end_s, robot.to_s);
      cost += mission.late_price * std::max<std::int64_t>(0, end_s - mission.due_s);
      place = mission.last;
    }
  }

  void chargers() {
    for (std::size_t c = 0; c < visits.size(); ++c)
      for (const auto& [from_s, to_s] : visits[c]) {
        const auto at_once =
            std::count_if(visits[c].begin(), visits[c].end(), [begin_s = from_s](const auto& other) {
              return other.first <= begin_s && begin_s < other.second;
            });
        EXPECT_LE(at_once, std::max(1, problem.chargers[c].count));
        EXPECT_LE(from_s, to_s);
      }
  }
};

/// Every mission once, no robot in two places or after its shift, no battery below its reserve, no charger
/// with too many robots, and the stated cost.
void expect_rules_kept(const RoutingProblem& problem, const DrivenRoutes& found) {
  Judged judged{problem};
  judged.visits.resize(problem.chargers.size());
  for (std::size_t r = 0; r < found.routes.size(); ++r) judged.route(static_cast<int>(r), found.routes[r]);
  judged.chargers();
  EXPECT_EQ(judged.cost, found.cost);
  std::sort(judged.driven.begin(), judged.driven.end());
  std::vector<int> all(problem.missions.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(judged.driven, all);
}

TEST(RouteDriver, KeepsEveryRule) {
  int driven = 0, charged = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RoutingProblem problem = drawn(seed);
    RouteDriver driver(problem);
    for (const auto& found : {driver.drive(inserted_orders(problem), kWaits_s), driver.dispatch(0.2, 0.9)}) {
      if (!found) continue;
      ++driven;
      expect_rules_kept(problem, *found);
      for (const auto& route : found->routes)
        charged += static_cast<int>(
            std::count_if(route.begin(), route.end(), [](const RouteStep& x) { return x.visit; }));
    }
  }
  EXPECT_GE(driven, 60);
  EXPECT_GE(charged, 60);
}

TEST(RouteDriver, RefusesWhereABatteryEndsWithoutAChargerAndWhereAShiftEnds) {
  RoutingProblem problem = drawn(1, {.chargers = 0, .level = 60'000});
  EXPECT_FALSE(RouteDriver(problem).drive(inserted_orders(problem), kWaits_s));
  problem = drawn(1);
  for (auto& robot : problem.robots) robot.to_s = 100;
  EXPECT_FALSE(RouteDriver(problem).drive(inserted_orders(problem), kWaits_s));
  EXPECT_FALSE(RouteDriver(problem).dispatch(0.2, 0.9));
}

TEST(RouteDriver, ALaterVisitWaitsForTheChargersOtherRobot) {
  RoutingProblem problem =
      drawn(2, {.robots = 1, .missions = 12, .chargers = 1, .types = 1, .level = 80'000});
  const Orders orders = inserted_orders(problem);
  const auto alone = RouteDriver(problem).drive(orders, 0);
  ASSERT_TRUE(alone);
  const auto first = std::find_if(alone->routes[0].begin(), alone->routes[0].end(),
                                  [](const RouteStep& step) { return step.visit; });
  ASSERT_NE(first, alone->routes[0].end());
  problem.busy = {{0, first->visit->from_s - 5, first->visit->from_s + 40}};
  const auto queued = RouteDriver(problem).drive(orders, 0);
  ASSERT_TRUE(queued);
  for (const RouteStep& step : queued->routes[0])
    EXPECT_TRUE(!step.visit || step.visit->to_s <= problem.busy[0].from_s ||
                step.visit->from_s >= problem.busy[0].to_s);
  EXPECT_GT(queued->cost, alone->cost);
}

TEST(OrderCost, TheExtraCostOfAnInsertionIsThatOfTheLongerOrder) {
  // With full batteries: the estimate ends early only where the rest of an order stays as it was.
  const RoutingProblem problem = drawn(4, {.robots = 1, .missions = 8, .level = 100'000'000});
  const OrderCost cost(problem);
  Random chance(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<int> order{0, 1, 2, 3, 4, 5, 6, 7};
    chance.shuffle(order);
    const int m = order.back();
    order.pop_back();
    const auto states = cost.states(0, order);
    const auto found = cost.insertion(0, order, states, m, std::numeric_limits<double>::infinity(), nullptr);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n <= order.size(); ++n) {
      std::vector<int> longer = order;
      longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(n), m);
      const double extra = cost.total(0, cost.states(0, longer)) - cost.total(0, states);
      least = std::min(least, extra);
      EXPECT_TRUE(n != found.position || std::abs(found.extra - extra) < 1e-6);
    }
    EXPECT_NEAR(found.extra, least, 1e-6);
  }
}

TEST(OrderCost, IsThatOfTheDrivenRouteWhereNothingIsCharged) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RoutingProblem problem = drawn(seed, {.level = 100'000'000});
    for (auto& mission : problem.missions) mission.due_s = 10'000'000;
    const OrderCost cost(problem);
    const Orders orders = inserted_orders(problem);
    double total = 0;
    for (std::size_t r = 0; r < orders.size(); ++r)
      total += cost.total(static_cast<int>(r), cost.states(static_cast<int>(r), orders[r]));
    const auto driven = RouteDriver(problem).drive(orders, 0);
    ASSERT_TRUE(driven);
    EXPECT_DOUBLE_EQ(total, static_cast<double>(driven->cost));
  }
}

TEST(OrderNeighborhood, HasEachMissionOnce) {
  for (const int chargers : {0, 2}) {
    const RoutingProblem problem = drawn(7, {.robots = 5, .missions = 30, .chargers = chargers});
    const OrderNeighborhood neighborhood(problem);
    Random chance(3);
    Orders orders = inserted_orders(problem);
    std::size_t changed = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const Orders next = neighborhood.of(orders, chance);
      std::vector<int> all;
      for (const auto& order : next) all.insert(all.end(), order.begin(), order.end());
      std::sort(all.begin(), all.end());
      for (int m = 0; m < 30; ++m) ASSERT_EQ(all.at(static_cast<std::size_t>(m)), m);
      ASSERT_EQ(all.size(), 30u);
      changed += next != orders;
      orders = next;
    }
    EXPECT_GE(changed, 30u);
  }
}

std::optional<DrivenRoutes> searched(const RoutingProblem& problem, std::uint64_t seed, std::size_t rounds,
                                     std::size_t chunk) {
  const Orders orders = inserted_orders(problem);
  std::optional<DrivenRoutes> best = RouteDriver(problem).drive(orders, kWaits_s);
  if (!best) return {};
  OrderSearch search(problem, orders, best->cost, seed, rounds);
  for (std::size_t n = 0; n < rounds; n += chunk)
    if (auto better = search.advance(chunk)) {
      EXPECT_LT(better->cost, best->cost);
      best = std::move(better);
    }
  return best;
}

TEST(OrderSearch, FindsCheaperRoutesThatKeepEveryRuleAndNeverDearerOnes) {
  int cheaper = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const RoutingProblem problem = drawn(seed);
    const auto start = RouteDriver(problem).drive(inserted_orders(problem), kWaits_s);
    const auto found = searched(problem, 1, 2000, 100);
    if (!start) continue;
    ASSERT_TRUE(found);
    expect_rules_kept(problem, *found);
    EXPECT_LE(found->cost, start->cost);
    cheaper += static_cast<double>(found->cost) < 0.98 * static_cast<double>(start->cost);
  }
  EXPECT_GE(cheaper, 5);
}

TEST(OrderSearch, TheSameSeedGivesTheSameRoutesInAnyPortions) {
  const RoutingProblem problem = drawn(5);
  const auto one = searched(problem, 7, 600, 600), other = searched(problem, 7, 600, 7);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->cost, other->cost);
  EXPECT_EQ(one->routes, other->routes);
}

/// The least cost of all orders, by enumeration.
std::int64_t least_cost(const RoutingProblem& problem) {
  const std::size_t robots = problem.robots.size();
  std::size_t splits = 1;
  std::vector<int> missions;
  for (int m = 0; m < static_cast<int>(problem.missions.size()); ++m) missions.push_back(m);
  for (std::size_t m = 0; m < missions.size(); ++m) splits *= robots;
  RouteDriver driver(problem);
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  do {
    for (std::size_t split = 0; split < splits; ++split) {
      Orders orders(robots);
      std::size_t rest = split;
      bool allowed = true;
      for (const int m : missions) {
        orders[rest % robots].push_back(m);
        const auto& own = problem.mission(m).robots;
        allowed = allowed && std::count(own.begin(), own.end(), static_cast<int>(rest % robots)) == 1;
        rest /= robots;
      }
      if (!allowed) continue;
      if (const auto driven = driver.drive(orders, kWaits_s)) least = std::min(least, driven->cost);
    }
  } while (std::next_permutation(missions.begin(), missions.end()));
  return least;
}

TEST(OrderSearch, IsAsCheapAsEveryOrderOfAFewMissionsInMostFleets) {
  int equal = 0;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    const RoutingProblem problem = drawn(seed, {.robots = 2, .missions = 5, .level = 120'000});
    const auto found = searched(problem, 1, 3000, 3000);
    ASSERT_TRUE(found);
    const std::int64_t least = least_cost(problem);
    EXPECT_GE(found->cost, least) << "seed " << seed;
    EXPECT_LE(static_cast<double>(found->cost), 1.2 * static_cast<double>(least)) << "seed " << seed;
    equal += found->cost == least;
  }
  EXPECT_GE(equal, 12);
}

}  // namespace
}  // namespace joulepath
