// Laws of orders and of routes on drawn fleets; the rules of a schedule are checked here by other code.
#include "extensions/fleet/order_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

struct Size {
  int robots{4}, missions{24}, chargers{2}, types{2};
  std::int64_t level{250'000};
};

RoutingProblem::Drives two_speeds(std::int64_t way_m) {
  return {{way_m + 3, 350 * way_m, 370 * way_m}, {way_m * 7 / 10 + 3, 430 * way_m, 450 * way_m}};
}

/// Places on a line; two types of robots and two speeds of each way; every robot may drive every mission.
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
    problem.chargers.push_back({place(), 1, 2500, 1000, {300'000, 300'000}});
  for (int m = 0; m < size.missions; ++m) {
    const std::int64_t ready_s = number(0, 500), way_m = number(5, 60);
    problem.missions.push_back({place(), place(), ready_s, ready_s + number(100, 900), 500, {}, {}});
    for (int r = 0; r < size.robots; ++r) problem.missions.back().robots.push_back(r);
    for (int t = 0; t < size.types; ++t)
      problem.missions.back().drives.push_back(two_speeds(way_m * (4 + t) / 4));
  }
  return problem;
}

/// Every mission once, no robot in two places, no battery below its reserve, no charger with two robots.
void expect_rules_kept(const RoutingProblem& problem, const Routes& routes) {
  std::vector<int> driven;
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> visits(problem.chargers.size());
  for (int r = 0; r < static_cast<int>(problem.robots.size()); ++r) {
    const auto& robot = problem.robot(r);
    const auto& type = problem.type_of(r);
    int place = robot.start;
    std::int64_t clock_s = robot.from_s, level = robot.level;
    const auto spend = [&](const RoutingProblem::Drive& drive, std::int64_t until_s) {
      EXPECT_GE(until_s, clock_s + drive.duration_s);
      level -= drive.upper + type.standby * (until_s - clock_s);
      clock_s = until_s;
      EXPECT_GE(level, type.reserve);
    };
    for (const RouteStep& step : routes[static_cast<std::size_t>(r)]) {
      const auto& mission = problem.mission(step.mission);
      driven.push_back(step.mission);
      if (step.visit) {
        const auto& charger = problem.charger(step.visit->charger);
        spend(problem.way(robot.type, place, charger.place).front(), step.visit->from_s);
        const auto seconds = static_cast<double>(step.visit->to_s - step.visit->from_s);
        const auto at_most = static_cast<double>(charger.power - type.standby) * seconds;
        EXPECT_LE(static_cast<double>(step.visit->target - level), at_most);
        visits[static_cast<std::size_t>(step.visit->charger)].emplace_back(step.visit->from_s,
                                                                           step.visit->to_s);
        place = charger.place;
        clock_s = step.visit->to_s;
        level = step.visit->target;
      }
      const auto& way = problem.way(robot.type, place, mission.first)[static_cast<std::size_t>(step.way)];
      EXPECT_GE(step.start_s, std::max(clock_s + way.duration_s, mission.ready_s));
      const auto& own = problem.drives(step.mission, robot.type)[static_cast<std::size_t>(step.speed)];
      const std::int64_t end_s = step.start_s + own.duration_s;
      spend({way.duration_s + own.duration_s, 0, way.upper + own.upper}, end_s);
      place = mission.last;
    }
  }
  std::sort(driven.begin(), driven.end());
  for (int m = 0; m < static_cast<int>(problem.missions.size()); ++m)
    ASSERT_EQ(driven.at(static_cast<std::size_t>(m)), m);
  EXPECT_EQ(driven.size(), problem.missions.size());
  for (auto& of_charger : visits) {
    std::sort(of_charger.begin(), of_charger.end());
    for (std::size_t n = 1; n < of_charger.size(); ++n)
      EXPECT_GE(of_charger[n].first, of_charger[n - 1].second);
  }
}

TEST(RouteDriver, KeepsEveryRule) {
  int driven = 0, charged = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RoutingProblem problem = drawn(seed);
    RouteDriver driver(problem);
    for (const auto& found : {driver.drive(inserted_orders(problem), kQueues_s), driver.dispatch(0.2, 0.9)}) {
      if (!found) continue;
      ++driven;
      expect_rules_kept(problem, found->routes);
      for (const auto& route : found->routes)
        charged += static_cast<int>(
            std::count_if(route.begin(), route.end(), [](const RouteStep& x) { return x.visit; }));
    }
  }
  EXPECT_GE(driven, 60);
  EXPECT_GE(charged, 100);
}

TEST(RouteDriver, RefusesWhereABatteryEndsWithoutAChargerAndWhereAShiftEnds) {
  RoutingProblem problem = drawn(1, {.chargers = 0, .level = 60'000});
  EXPECT_FALSE(RouteDriver(problem).drive(inserted_orders(problem), kQueues_s));
  problem = drawn(1);
  for (auto& robot : problem.robots) robot.to_s = 100;
  EXPECT_FALSE(RouteDriver(problem).drive(inserted_orders(problem), kQueues_s));
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
  std::optional<DrivenRoutes> best = RouteDriver(problem).drive(orders, kQueues_s);
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
    const auto start = RouteDriver(problem).drive(inserted_orders(problem), kQueues_s);
    const auto found = searched(problem, 1, 2000, 100);
    if (!start) continue;
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cost, routes_cost(problem, found->routes));
    expect_rules_kept(problem, found->routes);
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
      for (const int m : missions) {
        orders[rest % robots].push_back(m);
        rest /= robots;
      }
      if (const auto driven = driver.drive(orders, kQueues_s)) least = std::min(least, driven->cost);
    }
  } while (std::next_permutation(missions.begin(), missions.end()));
  return least;
}

TEST(OrderSearch, IsAsCheapAsEveryOrderOfAFewMissions) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RoutingProblem problem = drawn(seed, {.robots = 2, .missions = 5, .level = 120'000});
    const auto found = searched(problem, 1, 3000, 3000);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cost, least_cost(problem)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace joulepath
