#include "planner/mission/visit_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "planner/mission/mission.hpp"
#include "planner/mission/time_front.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// An empty floor of 24 m x 24 m with walls around.
OccupancyGrid visit_floor() {
  OccupancyGrid grid{.width = 120, .height = 120, .resolution_m = 0.2};
  grid.occupancy_percent.assign(120 * 120, 0);
  for (std::size_t k = 0; k < 120; ++k)
    for (std::size_t edge : {k, 119 * 120 + k, k * 120, k * 120 + 119}) grid.occupancy_percent[edge] = 100;
  return grid;
}

VisitRequest pick(const std::string& station, double payload_kg) {
  return {
      .kind = VisitRequest::Kind::pick, .station = station, .payload_kg = payload_kg, .payload_given = true};
}

/// A light load nearby, a heavy one far away, another light one on the way; all go back to the dock.
MissionRequest round_trip() {
  MissionRequest mission{.name = "round"};
  mission.stations = {{"dock", {.x_m = 2, .y_m = 2, .heading_rad = 0.0}},
                      {"near", {.x_m = 6, .y_m = 3}},
                      {"far", {.x_m = 20, .y_m = 4}},
                      {"side", {.x_m = 12, .y_m = 12}}};
  mission.start = {.station = "dock", .pose = {2, 2, 0}};
  mission.visit = {pick("near", 6.0),
                   pick("far", 1.0),
                   pick("side", 2.0),
                   {.kind = VisitRequest::Kind::drop, .station = "dock"}};
  return mission;
}

Plan visit_plan(const MissionRequest& mission, const Robot& robot = testing::nomad()) {
  return plan_mission(mission, {.robot = robot, .map = visit_floor()},
                      {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
}

TEST(VisitOrder, NoOtherOrderTakesLessWhenPlannedInFull) {
  const MissionRequest mission = round_trip();
  const Plan chosen = visit_plan(mission);
  ASSERT_TRUE(chosen.visit);
  EXPECT_TRUE(chosen.visit->exact);
  EXPECT_EQ(chosen.visit->order.back(), 3u);  // the drop waits for the picks before it
  EXPECT_LE(chosen.visit->lower_bound_J, chosen.energy.total_J());
  std::vector<std::size_t> order{0, 1, 2};
  do {
    MissionRequest fixed = mission;
    fixed.visit.clear();
    double payload_kg = 0.0;
    for (const std::size_t k : order) {
      fixed.legs.push_back({.to = mission.visit[k].station, .payload = {payload_kg, payload_kg}});
      payload_kg += mission.visit[k].payload_kg;
    }
    fixed.legs.push_back({.to = "dock", .payload = {payload_kg, payload_kg}});
    const Plan other = visit_plan(fixed);
    ASSERT_FALSE(other.legs.empty()) << other.message;
    EXPECT_GE(other.energy.total_J(), 0.9999 * chosen.energy.total_J());
    if (std::is_sorted(order.begin(), order.end())) {
      EXPECT_NEAR(chosen.visit->given_order_J.value(), other.energy.total_J(), 0.3 * other.energy.total_J());
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(VisitOrder, AWindowTurnsTheOrderRound) {
  MissionRequest mission = round_trip();
  const std::size_t free_first = visit_plan(mission).visit->order.front();
  const std::size_t other = free_first == 1 ? 0 : 1;
  mission.visit[other].window_s = {0.0, 25.0};
  for (std::size_t k = 0; k < 3; ++k)
    if (k != other) mission.visit[k].window_s = {26.0, 1000.0};
  const Plan plan = visit_plan(mission);
  ASSERT_FALSE(plan.infeasibility) << plan.message;
  EXPECT_EQ(plan.visit->order.front(), other);
  EXPECT_LE(plan.legs[0].start_s + plan.legs[0].duration_s, 25.0);
}

/// A window that the most economical drive misses and a faster one meets, compared with the same stops as
/// legs.
/// The robot is early and waits for the window: duration and standby energy count the wait.
TEST(VisitOrder, TheWaitForAWindowIsPartOfThePlan) {
  MissionRequest mission = round_trip();
  mission.visit[1].window_s = {600, 900};
  Robot robot = testing::nomad();
  robot.power.standby_W = 10;
  const Plan plan = visit_plan(mission, robot);
  ASSERT_EQ(plan.status <= SolveStatus::feasible, true) << plan.message;
  EXPECT_GT(plan.duration_s, 600);
  EXPECT_NEAR(plan.energy.standby_J, 10 * plan.duration_s, 1e-6 * plan.energy.standby_J);
  double time_s = 0, sum_J = 0;
  for (const LegPlan& leg : plan.legs) {
    EXPECT_NEAR(leg.start_s, time_s, 1e-6);
    time_s += leg.duration_s + leg.dwell_s;
    sum_J += leg.energy.total_J();
  }
  EXPECT_NEAR(time_s, plan.duration_s, 1e-6);
  EXPECT_NEAR(sum_J, plan.energy.total_J(), 1e-6 * sum_J);
}

/// The time until a window opens is used: no other duration of the leg before it, followed by a wait, takes
/// less.
TEST(VisitOrder, ALegBeforeAWindowDrivesAsSlowlyAsPays) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 10;
  for (const double opens_s : {40.0, 600.0}) {
    MissionRequest mission = round_trip();
    mission.visit = {{.kind = VisitRequest::Kind::pass, .station = "far", .window_s = {{opens_s, 900.0}}}};
    const Plan plan = visit_plan(mission, robot);
    ASSERT_EQ(plan.status, SolveStatus::optimal) << plan.message;
    MissionRequest leg = mission;
    leg.visit.clear();
    leg.legs = {{.to = "far", .payload = {}}};
    const double free_s = visit_plan(leg, robot).duration_s;
    ASSERT_LT(1.1 * free_s, opens_s);
    const double taken_J = plan.legs[0].energy.total_J();
    double best_J = kNoLimit;
    for (double duration_s = free_s; duration_s <= opens_s; duration_s *= 1.3) {
      leg.legs[0].duration_s = duration_s;
      const Plan given = visit_plan(leg, robot);
      best_J = std::min(best_J, given.energy.total_J() + 10 * (opens_s - given.duration_s));
    }
    EXPECT_LE(taken_J, best_J * (1 + 1e-4)) << opens_s;
    EXPECT_NEAR(plan.legs[0].duration_s, opens_s, 1e-3);
  }
}

/// All orders of a mission's stops, each planned as legs with the windows as deadlines; the least energy, or
/// nothing where none arrives in time.
std::optional<double> least_of_all_orders_J(const MissionRequest& mission, const Robot& robot) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < mission.visit.size(); ++k) order.push_back(k);
  std::optional<double> least_J;
  do {
    MissionRequest fixed = mission;
    fixed.visit.clear();
    double payload_kg = 0.0;
    for (const std::size_t k : order) {
      const VisitRequest& visit = mission.visit[k];
      fixed.legs.push_back(
          {.to = visit.station, .payload = {payload_kg, payload_kg}, .dwell_s = visit.dwell_s});
      if (visit.window_s) fixed.legs.back().deadline_s = visit.window_s->second;
      payload_kg += visit.payload_kg;
    }
    const Plan plan = visit_plan(fixed, robot);
    if (plan.status <= SolveStatus::feasible)
      least_J = std::min(plan.energy.total_J(), least_J.value_or(kNoLimit));
  } while (std::next_permutation(order.begin(), order.end()));
  return least_J;
}

/// Stops drawn on the floor, with a window that ends just after the arrival of a drawn order in least time.
MissionRequest drawn_windows(unsigned seed, std::size_t stops, double share, const Robot& robot) {
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  MissionRequest mission{.name = "drawn"};
  mission.start = {.pose = {3, 3, uniform(-3, 3)}};
  MissionRequest legs = mission;
  legs.objective.minimize = Objective::Minimize::time;
  for (std::size_t k = 0; k < stops; ++k) {
    const std::string name(1, static_cast<char>('a' + k));
    mission.stations[name] = {.x_m = uniform(2, 10), .y_m = uniform(2, 10)};
    if (uniform(0, 1) < 0.4) mission.stations[name].heading_rad = uniform(-3, 3);
    mission.visit.push_back(pick(name, uniform(0, 3)));
    mission.visit.back().dwell_s = uniform(0, 5);
  }
  legs.stations = mission.stations;
  double payload_kg = 0.0;
  for (const VisitRequest& visit : mission.visit) {
    legs.legs.push_back({.to = visit.station, .payload = {payload_kg, payload_kg}, .dwell_s = visit.dwell_s});
    payload_kg += visit.payload_kg;
  }
  const Plan fastest = visit_plan(legs, robot);
  const std::size_t tight = stops - 1 - seed % 2;
  const LegPlan& leg = fastest.legs.at(tight);
  mission.visit[tight].window_s = {{0.0, share * (leg.start_s + leg.duration_s)}};
  std::shuffle(mission.visit.begin(), mission.visit.end(), random);
  return mission;
}

/// With windows a visit is the best of all orders as legs: never refused where one of them fits, never
/// dearer.
TEST(VisitOrder, WithWindowsItIsTheBestOfAllOrders) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 10;
  int late_orders = 0;
  for (const auto& [seed, stops, share] :
       {std::tuple(1u, 2u, 1.001), std::tuple(2u, 2u, 1.001), std::tuple(3u, 2u, 1.02)}) {
    const MissionRequest mission = drawn_windows(seed, stops, share, robot);
    const std::optional<double> least_J = least_of_all_orders_J(mission, robot);
    ASSERT_TRUE(least_J) << seed;
    const Plan plan = visit_plan(mission, robot);
    ASSERT_LE(plan.status, SolveStatus::feasible) << seed << ": " << plan.message;
    EXPECT_LE(plan.energy.total_J(), *least_J * (1 + 1e-6)) << seed;
    EXPECT_GE(plan.visit->planned_orders, 1);
    EXPECT_LE(plan.visit->planned_orders, 24);
    if (plan.visit->planned_orders > 1) ++late_orders;
  }
  EXPECT_GT(late_orders, 0) << "windows that make no difference test nothing";
}

/// An order that empties the battery is not the only one.
TEST(VisitOrder, AnotherOrderIsPlannedWhereTheFirstEmptiesTheBattery) {
  MissionRequest mission = round_trip();
  mission.visit.erase(mission.visit.begin() + 1);
  const Plan full = visit_plan(mission);
  ASSERT_TRUE(full.battery);
  const double used = full.battery->start_fraction - full.battery->end_fraction;
  mission.start.battery_fraction = testing::nomad().battery.reserve_fraction + 0.99 * used;
  const Plan plan = visit_plan(mission);
  EXPECT_TRUE(plan.infeasibility);
  EXPECT_GT(plan.visit->planned_orders, 1);
  EXPECT_LE(plan.visit->planned_orders, 24);
}

TEST(VisitOrder, AWindowThatAFasterDriveKeepsIsKept) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 0;
  MissionRequest as_legs = round_trip();
  as_legs.visit.clear();
  as_legs.legs = {{.to = "far"}, {.to = "side"}};
  const Plan free = visit_plan(as_legs, robot);
  as_legs.objective.minimize = Objective::Minimize::time;
  const Plan fastest = visit_plan(as_legs, robot);
  ASSERT_LT(fastest.duration_s, 0.97 * free.duration_s);
  for (double share : {0.1, 0.5, 0.9}) {
    const double latest_s = fastest.duration_s + share * (free.duration_s - fastest.duration_s);
    MissionRequest mission = round_trip();
    mission.visit = {
        {.kind = VisitRequest::Kind::pass, .station = "far", .window_s = {{0.0, 0.8 * latest_s}}},
        {.kind = VisitRequest::Kind::pass, .station = "side", .window_s = {{0.0, latest_s}}}};
    const Plan plan = visit_plan(mission, robot);
    ASSERT_FALSE(plan.infeasibility) << share << ": " << plan.message;
    EXPECT_LE(plan.duration_s, latest_s * (1 + 1e-6)) << share;
    EXPECT_LE(plan.energy.total_J(), 1.05 * fastest.energy.total_J()) << share;
  }
}

/// A wall with a gap far aside: routes of the table stop and turn at its corners, the plan rounds them. What
/// the plan of the same stop as a leg reaches in time is a window that a visit keeps.
TEST(VisitOrder, AWindowThatTheSameStopAsALegMeetsIsKept) {
  OccupancyGrid floor = visit_floor();
  for (std::size_t x = 0; x < 100; ++x) floor.occupancy_percent[60 * 120 + x] = 100;
  const auto plan_on = [&](const MissionRequest& mission) {
    return plan_mission(mission, {.robot = testing::nomad(), .map = floor},
                        {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
  };
  MissionRequest mission{.name = "gap"};
  mission.stations = {{"beyond", {.x_m = 14, .y_m = 18}}};
  mission.start = {.pose = {6, 4, 0}};
  mission.legs = {{.to = "beyond"}};
  mission.objective.minimize = Objective::Minimize::time;
  const Plan fastest = plan_on(mission);
  ASSERT_LE(fastest.status, SolveStatus::feasible) << fastest.message;
  mission.legs.clear();
  mission.objective = {};
  const auto visit_until = [&](double latest_s) {
    mission.visit = {{.kind = VisitRequest::Kind::pass, .station = "beyond", .window_s = {{0.0, latest_s}}}};
    return plan_on(mission);
  };
  const Plan kept = visit_until(1.002 * fastest.duration_s);
  EXPECT_LE(kept.status, SolveStatus::feasible) << kept.message;
  const Plan missed = visit_until(0.8 * fastest.duration_s);
  ASSERT_TRUE(missed.infeasibility);
  EXPECT_EQ(missed.infeasibility->reason.constraint, "visit_order");
  EXPECT_NEAR(missed.infeasibility->reason.amount, 0.2 * fastest.duration_s, 0.01 * fastest.duration_s);
  const Plan relaxed = visit_until(missed.infeasibility->reason.relaxation.at("window_s"));
  EXPECT_LE(relaxed.status, SolveStatus::feasible) << relaxed.message;
}

/// Costs of two drives in a row, by a search over all splits of the time.
TEST(TimeFront, SumSharesTheTimeAtBest) {
  const TimeFront first = TimeFront::below({{4, 90}, {5, 60}, {7, 40}, {6, 80}, {9, 39}});
  const TimeFront second = TimeFront::below({{2, 30}, {3, 22}, {6, 20}, {7, 25}});
  const TimeFront sum = first + second;
  for (double time_s = 6; time_s < 18; time_s += 0.25) {
    double least_J = kNoLimit;
    for (double share_s = 4; share_s <= time_s - 2; share_s += 0.0625)
      least_J = std::min(least_J, first.at(share_s) + second.at(time_s - share_s));
    EXPECT_NEAR(sum.at(time_s), least_J, 1e-9) << time_s;
  }
  EXPECT_TRUE(sum.is_below(sum));
  TimeFront later = sum;
  later.shift(1, 0);
  EXPECT_TRUE(sum.is_below(later));
  EXPECT_FALSE(later.is_below(sum));
}

TEST(TimeFront, WindowsCutItAndWaitingCostsStandby) {
  TimeFront front = TimeFront::below({{4, 90}, {5, 60}, {7, 40}});
  front.wait_until(6, 10);
  EXPECT_DOUBLE_EQ(front.soonest_s(), 6);
  EXPECT_DOUBLE_EQ(front.at(6), 50);
  front.end_at(6.5);
  EXPECT_DOUBLE_EQ(front.least_J(), 45);
  front.wait_until(8, 10);
  EXPECT_DOUBLE_EQ(front.least_J(), 60);
}

TEST(VisitOrder, MoreThanTheRobotCarriesHasNoOrder) {
  MissionRequest mission = round_trip();
  mission.visit[1].payload_kg = 8.0;  // 16 kg before the only drop, 12 allowed
  const Plan plan = visit_plan(mission);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "visit_order");
  EXPECT_NEAR(plan.infeasibility->reason.amount, 4.0, 1e-9);
  EXPECT_EQ(plan.infeasibility->reason.unit, "kg");
}

TEST(VisitOrder, AWindowThatNoOrderMeetsIsNamedWithTheSecondsMissing) {
  MissionRequest mission = round_trip();
  mission.visit[1].window_s = {0.0, 5.0};  // 18 m away
  const Plan plan = visit_plan(mission);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "visit_order");
  EXPECT_NE(plan.message.find("'far' (visit[1])"), std::string::npos) << plan.message;
  const double late_s = plan.infeasibility->reason.amount;
  EXPECT_GT(late_s, 18.0 / 1.0 - 5.0);  // not even at full speed all the way
  mission.visit[1].window_s = {0.0, 5.0 + late_s + 1e-6};
  EXPECT_FALSE(visit_plan(mission).infeasibility);
}

// A leg that does not drive says nothing about the table.
TEST(VisitOrder, StopsWhereTheRobotIsAlreadyChangeNoOrder) {
  const Plan plain = visit_plan(round_trip());
  MissionRequest mission = round_trip();
  mission.visit.insert(mission.visit.begin(), {.kind = VisitRequest::Kind::pass, .station = "dock"});
  mission.visit.insert(mission.visit.begin() + 2, {.kind = VisitRequest::Kind::pass, .station = "near"});
  const Plan plan = visit_plan(mission);
  ASSERT_FALSE(plan.infeasibility) << plan.message;
  EXPECT_LE(plan.energy.total_J(), 1.001 * plain.energy.total_J());
}

TEST(VisitOrder, AStopInAWallIsNamed) {
  MissionRequest mission = round_trip();
  mission.stations["far"].x_m = 23.95;
  const Plan plan = visit_plan(mission);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "path");
  EXPECT_NE(plan.message.find("far"), std::string::npos);
}

}  // namespace
}  // namespace joulepath
