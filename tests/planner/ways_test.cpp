#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "planner/accounts/battery_account.hpp"
#include "planner/legs/on_ways.hpp"
#include "planner/mission/mission.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/ways/way_chain.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// A floor of 24 m x 24 m with walls around and a rack in the middle.
OccupancyGrid floor_with_rack() {
  OccupancyGrid grid = free_grid(240, 240, 0.1);
  const auto fill = [&](int column0, int row0, int column1, int row1) {
    for (int row = row0; row < row1; ++row)
      for (int column = column0; column < column1; ++column)
        grid.occupancy_percent[static_cast<std::size_t>(row * 240 + column)] = 100;
  };
  fill(0, 0, 240, 1);
  fill(0, 239, 240, 240);
  fill(0, 0, 1, 240);
  fill(239, 0, 240, 240);
  fill(80, 60, 160, 100);
  return grid;
}

/// Three stops around the rack; only the dock has a heading.
MissionRequest round_of_three() {
  MissionRequest mission{.name = "round", .clearance_m = 0.05};
  mission.stations = {{"dock", {.x_m = 2, .y_m = 2, .heading_rad = 0.0, .charger_W = 200}},
                      {"east", {.x_m = 20, .y_m = 6}},
                      {"north", {.x_m = 10, .y_m = 18}}};
  mission.start = {.station = "dock", .pose = {2, 2, 0}};
  mission.legs = {{.to = "east"}, {.to = "north", .payload = {5, 5}}, {.to = "dock", .payload = {5, 5}}};
  return mission;
}

Plan plan_of(const MissionRequest& mission, const PlanOptions& options,
             const Robot& robot = testing::nomad()) {
  return plan_mission(mission, {.robot = robot, .map = floor_with_rack()}, options);
}

const PlanOptions kCoarse{.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3, .baselines = false};

TEST(Ways, TheChosenWayIsTheCheapestOfAllThatWereScored) {
  PlanOptions options = kCoarse;
  options.steps.refinement = false;
  const Plan plan = plan_of(round_of_three(), options);
  ASSERT_EQ(plan.legs.size(), 3u) << plan.message;
  for (const LegPlan& leg : plan.legs) {
    ASSERT_FALSE(leg.alternatives.empty());
    const auto chosen = std::find_if(leg.alternatives.begin(), leg.alternatives.end(),
                                     [](const PathAlternative& a) { return a.chosen; });
    ASSERT_NE(chosen, leg.alternatives.end());
    for (const PathAlternative& other : leg.alternatives)
      EXPECT_LE(chosen->energy_J, other.energy_J * (1 + 1e-12)) << other.name;
  }
}

TEST(Ways, EveryStepLowersTheCostAndTheWholeIsWhatIsDriven) {
  const Plan plan = plan_of(round_of_three(), kCoarse);
  ASSERT_EQ(plan.legs.size(), 3u) << plan.message;
  std::vector<double> cost_J(5, 0.0);
  for (const LegPlan& leg : plan.legs) {
    ASSERT_EQ(leg.improvements.size(), cost_J.size());
    for (std::size_t i = 0; i < cost_J.size(); ++i) cost_J[i] += leg.improvements[i].cost_J;
  }
  for (std::size_t i = 1; i < cost_J.size(); ++i) EXPECT_LE(cost_J[i], cost_J[i - 1] * (1 + 1e-12)) << i;
  EXPECT_LT(cost_J.back(), 0.98 * cost_J.front());
  // No deadline: a second has no price beyond standby, so the last step's cost is the plan's energy.
  EXPECT_NEAR(plan.energy.total_J(), cost_J.back(), 0.01 * cost_J.back());
}

/// Drafts of ways leave the jerk limit out. Still the plan of least time is no slower than any other, and a
/// deadline that a plan of least energy keeps is no reason for a refusal.
TEST(Ways, NoPlanUnderAJerkLimitIsFasterThanTheFastest) {
  for (const double jerk : {0.3, 0.7, 1.5}) {
    Robot robot = testing::nomad();
    robot.limits->jerk_m_s3 = jerk;
    MissionRequest mission = round_of_three();
    mission.legs.pop_back();
    const Plan frugal = plan_of(mission, kCoarse, robot);
    ASSERT_LE(frugal.status, SolveStatus::feasible) << frugal.message;
    mission.objective.deadline_s = frugal.duration_s * (1 + 1e-6);
    EXPECT_LE(plan_of(mission, kCoarse, robot).status, SolveStatus::feasible) << jerk;
    mission.objective = {.minimize = Objective::Minimize::time};
    const double fastest_s = plan_of(mission, kCoarse, robot).duration_s;
    EXPECT_LE(fastest_s, frugal.duration_s * (1 + 1e-6)) << jerk;
    for (const double value_W : {100.0, 3000.0}) {
      mission.objective = {.minimize = Objective::Minimize::energy_and_time, .time_value_W = value_W};
      EXPECT_LE(fastest_s, plan_of(mission, kCoarse, robot).duration_s * (1 + 1e-4)) << jerk;
    }
  }
}

/// Of the mission and of each of its legs.
TEST(Ways, ADeadlineThatDoesNotBindChangesNothing) {
  const Plan free = plan_of(round_of_three(), kCoarse);
  ASSERT_LE(free.status, SolveStatus::feasible) << free.message;
  for (std::size_t k = 0; k <= free.legs.size(); ++k) {
    MissionRequest mission = round_of_three();
    if (k == free.legs.size())
      mission.objective.deadline_s = 1.01 * free.duration_s;
    else
      mission.legs[k].deadline_s = 1.03 * (free.legs[k].start_s + free.legs[k].duration_s);
    const Plan plan = plan_of(mission, kCoarse);
    ASSERT_LE(plan.status, SolveStatus::feasible) << k << ": " << plan.message;
    EXPECT_NEAR(plan.energy.total_J(), free.energy.total_J(), 1e-9 * free.energy.total_J()) << k;
    EXPECT_NEAR(plan.duration_s, free.duration_s, 1e-9 * free.duration_s) << k;
  }
}

/// Between the fastest drive and the cheapest one.
TEST(Ways, ADeadlineCostsNoMoreThanOnTheWaysWithoutIt) {
  MissionRequest mission = round_of_three();
  const Plan cheapest = plan_of(mission, kCoarse);
  mission.objective.minimize = Objective::Minimize::time;
  const Plan fastest = plan_of(mission, kCoarse);
  ASSERT_LE(std::max(cheapest.status, fastest.status), SolveStatus::feasible);
  mission.objective.minimize = Objective::Minimize::energy;
  int compared = 0;
  for (const double share : {0.2, 0.6}) {
    mission.objective.deadline_s = std::lerp(fastest.duration_s, cheapest.duration_s, share);
    const Plan plan = plan_of(mission, kCoarse), same_ways = plan_of(on_ways_of(cheapest, mission), kCoarse);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    if (same_ways.status > SolveStatus::feasible) continue;
    ++compared;
    EXPECT_LE(plan.energy.total_J(), 1.0002 * same_ways.energy.total_J()) << share;
  }
  EXPECT_GT(compared, 0);
}

TEST(Ways, AHeadingAtAStopIsReachedByAnArcWhereThatIsCheaper) {
  PlanOptions turning = kCoarse;
  turning.steps.refinement = false;  // refinement would replace turns by curves
  const PlanOptions bending = turning;
  turning.steps.stops = false;
  const Plan turned = plan_of(round_of_three(), turning), bent = plan_of(round_of_three(), bending);
  double turned_rad = 0.0, bent_rad = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    turned_rad += turned.legs[k].turned_rad, bent_rad += bent.legs[k].turned_rad;
  EXPECT_LT(bent_rad, turned_rad);
  EXPECT_LT(bent.energy.total_J(), turned.energy.total_J());
  const PathPiece& last = bent.legs.back().stretches.back().request.piece;
  EXPECT_NEAR(wrapped_angle_rad(piece_point(last, piece_length(last)).pose.heading_rad), 0.0, 1e-9);
}

TEST(Ways, TheSameSeedGivesTheSamePlanAndAnotherSeedNearlyThatEnergy) {
  PlanOptions other = kCoarse;
  other.seed = 7;
  const double energy_J = plan_of(round_of_three(), kCoarse).energy.total_J();
  EXPECT_EQ(plan_of(round_of_three(), kCoarse).energy.total_J(), energy_J);
  EXPECT_NEAR(plan_of(round_of_three(), other).energy.total_J(), energy_J, 0.005 * energy_J);
}

/// Of a straight leg on a free part of the floor, or with headings a little off the line. `at_goal`: 0 for a
/// goal without a heading, 1 for the start's, -1 for its mirror image.
double straight_leg_J(double length_m, double off_rad, int at_goal) {
  MissionRequest mission{.name = "line"};
  mission.stations = {{"goal", {.x_m = 3 + length_m, .y_m = 18}}};
  if (at_goal != 0) mission.stations.at("goal").heading_rad = at_goal * off_rad;
  mission.start = {.pose = {3, 18, off_rad}};
  mission.legs = {{.to = "goal"}};
  const Plan plan = plan_of(mission, kCoarse);
  return plan.status <= SolveStatus::feasible ? plan.energy.total_J() : std::nan("");
}

TEST(Ways, HeadingsALittleOffTheLineCostHardlyMore) {
  for (const double length_m : {2.0, 5.0, 12.0})
    for (const bool named : {false, true}) {
      const double in_line_J = straight_leg_J(length_m, 0, named);
      for (const double off_rad : {1e-5, 1e-4, -0.01, 0.035})
        for (const int at_goal : named ? std::vector{1, -1} : std::vector{0})
          EXPECT_LT(straight_leg_J(length_m, off_rad, at_goal), 1.002 * in_line_J)
              << length_m << " m, " << off_rad << ", " << at_goal;
    }
}

/// Energy along the north wall from a place whose clearance touches it to another; turns first where asked.
double along_wall_J(double slack_m, double start_rad, double goal_rad, bool turns_first = false) {
  const double y_m = 23.9 - testing::nomad().footprint.radius_m - 0.05 - slack_m;
  MissionRequest mission{.name = "wall", .clearance_m = 0.05};
  mission.stations = {{"turned", {.x_m = 3, .y_m = y_m, .heading_rad = 0.0}},
                      {"goal", {.x_m = 8, .y_m = y_m, .heading_rad = goal_rad}}};
  mission.start = {.pose = {3, y_m, start_rad}};
  if (turns_first) mission.legs = {{.to = "turned"}};
  mission.legs.push_back({.to = "goal"});
  const Plan plan = plan_of(mission, kCoarse);
  return plan.status <= SolveStatus::feasible ? plan.energy.total_J() : std::nan("");
}

// A turn by 0.02 rad cost 50 % of the leg: the way stopped three times to keep away from a wall that it may
// touch.
TEST(Ways, ATurnBeforeTheLegIsNoCheaperThanTheLegBesideAWall) {
  for (const double slack_m : {0.0, 1e-3, 0.02})
    for (const double start_rad : {0.02, 0.5, 1.57})
      for (const double goal_rad : {0.0, -1.57}) {
        const double turned_J = along_wall_J(slack_m, start_rad, goal_rad, true);
        EXPECT_LT(along_wall_J(slack_m, start_rad, goal_rad), 1.002 * turned_J)
            << slack_m << " m, " << start_rad << ", " << goal_rad;
        EXPECT_LT(turned_J, 1.5 * along_wall_J(0.5, 0, 0))
            << slack_m << " m, " << start_rad << ", " << goal_rad;
      }
}

/// Wheels that hardly turn backward leave no turn in place within the motors' current, but arcs.
TEST(Ways, ARobotThatCannotTurnInPlaceDrivesArcs) {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_current_A = 0.35;
  robot.effects = {{.name = "direction_dependent_friction", .parameters = {{"reverse_torque_Nm", 0.3}}}};
  MissionRequest mission{.name = "arcs", .clearance_m = 0.05};
  mission.start = {.pose = {3, 12, 0}};
  for (const double side : {1.0, -1.0}) {
    mission.stations = {{"b", {.x_m = 6.5, .y_m = 12 + 1.5 * side, .heading_rad = side}}};
    mission.legs = {{.to = "b"}};
    const Plan plan = plan_of(mission, kCoarse, robot);
    ASSERT_TRUE(is_driven(plan)) << plan.message;
    for (const StretchPlan& stretch : plan.legs.front().stretches)
      EXPECT_FALSE(is_turn(stretch.request.piece));
  }
}

/// A verdict is of one place; what it offers is enough for the whole mission, or is not offered.
TEST(Ways, WhatAVerdictOffersIsEnoughForTheMission) {
  Robot robot = testing::nomad();
  for (const Side side : kSides) robot.motor[side].max_current_A = 0.5;
  robot.effects = {{.name = "floor_slope", .parameters = {{"grade", 0.08}, {"uphill_direction_rad", 1.2}}}};
  MissionRequest mission = round_of_three();
  mission.legs.back().payload = {10, 10};
  const Plan refused = plan_of(mission, kCoarse, robot);
  ASSERT_TRUE(refused.infeasibility);
  const auto& offers = refused.infeasibility->reason.relaxation;
  ASSERT_TRUE(offers.contains("max_current_A")) << refused.message;
  for (const Side side : kSides) robot.motor[side].max_current_A = offers.at("max_current_A");
  EXPECT_TRUE(is_driven(plan_of(mission, kCoarse, robot)));
}

TEST(WayChain, IsNoDearerThanAnyOtherChoice) {
  const Robot robot = testing::nomad();
  const Plant plant = make_plant(robot);
  const MissionRequest mission = round_of_three();
  const MissionWorld world{.robot = robot};
  const ChoiceContext context{mission, world, nullptr, plant, kCoarse, 2.0};
  TurnScores turns(context);
  std::vector<std::vector<Way>> ways(3);
  for (std::size_t leg = 0; leg < 3; ++leg)
    for (std::size_t k = 0; k < 3; ++k)
      ways[leg].push_back({.leaves_rad = 1.1 * static_cast<double>(k) - 0.3 * static_cast<double>(leg),
                           .arrives_rad = 2.0 - 0.9 * static_cast<double>(k * leg),
                           .score = {50.0 + 4.0 * static_cast<double>(k), 20.0, true}});
  ChainRequest request{.start = {0, 0, 0}};
  for (std::size_t leg = 0; leg < 3; ++leg)
    request.legs.push_back(
        {.ways = &ways[leg], .price_W = 2.0, .goal_payload_kg = 5.0 * (leg == 1), .turns = &turns});
  request.legs.back().goal_heading_rad = 0.5;
  const auto cost_J = [&](const std::vector<ChainChoice>& chain) {
    double sum_J = 0.0;
    for (const ChainChoice& choice : chain) sum_J += choice.score.cost_J(2.0);
    return sum_J;
  };
  const auto any = [](std::size_t, const Way&) { return true; };
  const double best_J = cost_J(cheapest_chain(request, any));
  double least_J = kNoLimit;
  for (std::size_t code = 0; code < 27; ++code) {
    const auto only = [&](std::size_t leg, const Way& way) {
      const std::size_t digit = leg == 0 ? code % 3 : leg == 1 ? code / 3 % 3 : code / 9;
      return &way == &ways[leg][digit];
    };
    least_J = std::min(least_J, cost_J(cheapest_chain(request, only)));
  }
  EXPECT_NEAR(best_J, least_J, 1e-9 * least_J);
}

TEST(Charging, AStopIsInsertedOnlyWhereTheReserveWouldBeBreached) {
  MissionRequest mission = round_of_three();
  mission.legs.push_back({.to = "east"});
  mission.charging = ChargingRequest{.stations = {"dock"}, .to_fraction = 0.9};
  Robot robot = testing::nomad();
  robot.battery.capacity_Wh = 1.0;
  mission.start.battery_fraction = 1.0;
  const Plan enough = plan_of(mission, kCoarse, robot);
  ASSERT_FALSE(enough.infeasibility) << enough.message;
  EXPECT_EQ(enough.legs.size(), 4u);
  robot.battery.capacity_Wh = 0.38;
  const Plan charged = plan_of(mission, kCoarse, robot);
  ASSERT_FALSE(charged.infeasibility) << charged.message;
  ASSERT_EQ(charged.legs.size(), 5u);
  EXPECT_GT(charged.battery->charged_J, 0.0);
  double drawn_J = 0.0;
  for (const LegPlan& leg : charged.legs) {
    EXPECT_TRUE(leg.charger_W > 0 || leg.charged_J == 0);
    drawn_J += leg.energy.total_J() - (leg.charger_W > 0 ? robot.power.standby_W * leg.dwell_s : 0.0);
  }
  for (const double fraction : charged.battery->fraction_after_leg)
    EXPECT_GE(fraction, robot.battery.reserve_fraction);
  // The charge at the end is the charge at the start, less the drawn energy and the losses, plus the energy
  // charged (without its own loss).
  const double balance =
      1.0 - (drawn_J + charged.battery->loss_J - charged.battery->charged_J) / (0.38 * 3600);
  EXPECT_NEAR(charged.battery->end_fraction, balance, 0.02);
  mission.charging.reset();
  EXPECT_EQ(plan_of(mission, kCoarse, robot).infeasibility->reason.constraint, "battery_reserve");
}

/// The charger is at the start and far from all other stops, between which the robot drives short ways until
/// its battery is empty: only a stop before the first leg helps.
TEST(Charging, AStopFarAheadOfTheLegThatFailsIsFound) {
  MissionRequest mission = round_of_three();
  mission.stations["one"] = {.x_m = 20, .y_m = 20};
  mission.stations["two"] = {.x_m = 18, .y_m = 20};
  mission.charging = ChargingRequest{.stations = {"dock"}, .to_fraction = 0.9};
  mission.legs = {{.to = "one"}, {.to = "two"}, {.to = "one"}, {.to = "two"}, {.to = "one"}};
  PlanOptions options = kCoarse;
  options.steps.corners = options.steps.refinement = false;
  Robot robot = testing::nomad();
  const Plan whole = plan_of(mission, options, robot);
  ASSERT_EQ(whole.legs.size(), 5u) << whole.message;
  const auto energy_Wh = [&](std::size_t leg) { return whole.legs[leg].energy.total_J() / 3600; };
  robot.battery.capacity_Wh = 1.1 * whole.energy.total_J() / 3600 / 0.8;
  const double until_third_Wh = energy_Wh(0) + energy_Wh(1) + energy_Wh(2) + 0.5 * energy_Wh(3);
  mission.start.battery_fraction =
      robot.battery.reserve_fraction + until_third_Wh / robot.battery.capacity_Wh;
  const Plan charged = plan_of(mission, options, robot);
  ASSERT_LE(charged.status, SolveStatus::feasible) << charged.message;
  EXPECT_GT(charged.legs[0].charged_J, 0.0);
  for (const double fraction : charged.battery->fraction_after_leg)
    EXPECT_GE(fraction, robot.battery.reserve_fraction);
}

/// What stands at it takes 10 W.
TEST(Charging, AChargerOfLessThanStandbyChargesNothing) {
  for (const double charger_W : {5.0, 50.0}) {
    Plan plan;
    plan.legs.resize(1);
    plan.legs[0].charger_W = charger_W, plan.legs[0].dwell_s = 60;
    const auto account = battery_account(plan, {.plant = make_plant(testing::nomad())}, 0.5, 0.9);
    ASSERT_TRUE(account);
    EXPECT_NEAR(account->charged_J, charger_W > 10 ? (charger_W - 10) * 60 : 0.0, 1e-9);
  }
}

/// The robot begins at a charger, and three legs later its charge ends: a detour back to the charger costs
/// more than to charge before the first leg.
TEST(Charging, AStopWithoutADetourIsTakenHoweverEarly) {
  MissionRequest mission = round_of_three();
  mission.stations["far"] = {.x_m = 21, .y_m = 18};
  mission.legs = {{.to = "east"}, {.to = "far"}, {.to = "north"}, {.to = "far"}, {.to = "north"}};
  Robot robot = testing::nomad();
  const Plan enough = plan_of(mission, kCoarse, robot);
  ASSERT_LE(enough.status, SolveStatus::feasible) << enough.message;
  mission.charging = ChargingRequest{.stations = {"dock"}, .to_fraction = 0.9};
  for (std::size_t fails = 3; fails < 5; ++fails) {
    double spent_J = -0.5 * enough.legs[fails].energy.total_J();
    for (std::size_t k = 0; k <= fails; ++k) spent_J += enough.legs[k].energy.total_J();
    robot.battery.capacity_Wh = 3 * enough.energy.total_J() / 3600;
    mission.start.battery_fraction =
        robot.battery.reserve_fraction + spent_J / (3600 * robot.battery.capacity_Wh);
    const Plan plan = plan_of(mission, kCoarse, robot);
    ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
    ASSERT_EQ(plan.legs.size(), 6u);
    EXPECT_GT(plan.legs[0].charged_J, 0.0) << fails;
    EXPECT_TRUE(std::ranges::any_of(plan.legs, [](const LegPlan& leg) {
      return std::ranges::any_of(leg.improvements,
                                 [](const auto& step) { return step.step == "refinement"; });
    })) << "the plan with the stop has refined paths";
    EXPECT_LT(plan.energy.total_J(),
              enough.energy.total_J() + 1.05 * robot.power.standby_W * plan.legs[0].dwell_s);
  }
}

/// A charger that feeds at least standby: the charge does not fall while the robot stays there, whether the
/// stay ends the mission, begins it or is on the way.
TEST(Charging, TheChargeDoesNotFallAtAChargerThatFeedsTheRobot) {
  for (const double charger_W : {10.0, 12.0, 200.0})
    for (const bool charging : {false, true}) {
      const auto fractions = [&](double dwell_s) {
        MissionRequest mission = round_of_three();
        mission.stations["dock"].charger_W = charger_W;
        mission.legs = {
            {.to = "dock", .dwell_s = dwell_s}, {.to = "east"}, {.to = "dock", .dwell_s = dwell_s}};
        mission.start.battery_fraction = 0.6;
        if (charging) mission.charging = ChargingRequest{.stations = {"dock"}, .to_fraction = 0.9};
        const Plan plan = plan_of(mission, kCoarse);
        EXPECT_LE(plan.status, SolveStatus::feasible) << plan.message;
        return plan.battery->fraction_after_leg;
      };
      const std::vector<double> none = fractions(0), stay = fractions(600);
      ASSERT_EQ(none.size(), stay.size());
      EXPECT_GE(stay[0], 0.6 - 1e-12) << charger_W;
      EXPECT_GE(stay[2], stay[1] + (none[2] - none[1]) - 1e-9) << charger_W;
      EXPECT_EQ(stay[0] > 0.6, charging && charger_W > 10) << charger_W;
    }
}

/// A weak charger on the way and a strong one aside: whatever the objective, the choice costs no more than
/// either one alone.
TEST(Charging, TheObjectiveChoosesTheCharger) {
  Robot robot = testing::nomad();
  robot.battery.capacity_Wh = 1.0;
  PlanOptions options = kCoarse;
  options.steps.corners = options.steps.refinement = false;
  std::set<std::pair<Objective::Minimize, std::string>> chosen;
  for (const Objective& objective :
       {Objective{.minimize = Objective::Minimize::energy}, Objective{.minimize = Objective::Minimize::time},
        Objective{.minimize = Objective::Minimize::energy_and_time, .time_value_W = 100}}) {
    MissionRequest mission = round_of_three();
    mission.objective = objective;
    mission.start.battery_fraction = robot.battery.reserve_fraction + 0.25;
    mission.stations["dock"].charger_W = 100;
    mission.stations["aside"] = {.x_m = 22, .y_m = 22, .charger_W = 2000};
    mission.charging = ChargingRequest{.stations = {"dock", "aside"}, .to_fraction = 0.9};
    const double both = cost(plan_of(mission, options, robot), objective);
    for (const std::string charger : {"dock", "aside"}) {
      mission.charging->stations = {charger};
      const Plan plan = plan_of(mission, options, robot);
      ASSERT_LE(plan.status, SolveStatus::feasible) << charger << ": " << plan.message;
      EXPECT_LE(both, cost(plan, objective) * (1 + 1e-6)) << charger;
      if (both >= cost(plan, objective) * (1 - 1e-6)) chosen.emplace(objective.minimize, charger);
    }
  }
  EXPECT_EQ(chosen.count({Objective::Minimize::energy, "dock"}), 1u) << "the weak one without a detour";
  EXPECT_EQ(chosen.count({Objective::Minimize::time, "aside"}), 1u) << "the strong one";
}

/// Energy that comes back to a full battery is lost.
TEST(Charging, AFullBatteryTakesUpNothing) {
  Plan plan;
  plan.legs.resize(2);
  plan.legs[0].energy.kinetic_J = -36000;
  const auto downhill = battery_account(plan, {.plant = make_plant(testing::nomad())}, 1.0, 0.9);
  ASSERT_TRUE(downhill);
  EXPECT_EQ(downhill->end_fraction, 1.0);
  EXPECT_TRUE(std::isinf(downhill->missions_per_charge));
  plan.legs[1].energy.kinetic_J = 36000;
  const auto back = battery_account(plan, {.plant = make_plant(testing::nomad())}, 1.0, 0.9);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->fraction_after_leg[0], 1.0);
  EXPECT_NEAR(back->required_capacity_Wh, 10.0, 1e-6);
}

/// After a charge at the start the mission needs what it draws from then on.
TEST(Charging, TheRequiredCapacityIsTheGreatestDischarge) {
  Plan plan;
  plan.legs.resize(2);
  plan.legs[0].charger_W = 3610, plan.legs[0].dwell_s = 60, plan.legs[0].energy.standby_J = 600;
  plan.legs[1].energy.kinetic_J = 36000;
  const auto account = battery_account(plan, {.plant = make_plant(testing::nomad())}, 0.2, 0.9);
  ASSERT_TRUE(account);
  EXPECT_GT(account->charged_J, 36000.0);
  EXPECT_NEAR(account->required_capacity_Wh, 10.0, 1e-6);
  EXPECT_EQ(account->missions_per_charge, 21.0);
}

/// What the charger lacks comes from the battery.
TEST(Charging, AWeakChargerFeedsItsPart) {
  for (const double charger_W : {0.0, 4.0, 9.0}) {
    Plan plan;
    plan.legs.resize(1);
    plan.legs[0].charger_W = charger_W, plan.legs[0].dwell_s = 360;
    plan.legs[0].energy.standby_J = 3600;
    const auto account = battery_account(plan, {.plant = make_plant(testing::nomad())}, 0.5, 0.9);
    ASSERT_TRUE(account);
    EXPECT_NEAR((0.5 - account->end_fraction) * 240, 1 - charger_W / 10, 0.01) << charger_W;
  }
}

/// An order names places that are no stations.
TEST(Charging, APlaceThatIsNoStationHasNoCharger) {
  LegRequest leg{.path = PathRequest{.bezier_m = {{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}}}}};
  leg.to = "n7";
  const MissionRequest mission{.name = "order", .legs = {leg}};
  const Plan plan = plan_mission(mission, {.robot = testing::nomad()}, kCoarse);
  ASSERT_LE(plan.status, SolveStatus::feasible) << plan.message;
  EXPECT_EQ(plan.legs[0].charger_W, 0.0);
}

TEST(EnergyBand, ErrorsOfLegsAreCorrelatedAndWithoutUncertaintyThereIsNone) {
  Robot robot = testing::nomad();
  EXPECT_FALSE(plan_of(round_of_three(), kCoarse, robot).energy_sigma_J);
  robot.uncertainty["standby_W"] = 0.1;
  const Plan plan = plan_of(round_of_three(), kCoarse, robot);
  ASSERT_TRUE(plan.energy_sigma_J);
  const double sigma_J = *plan.energy_sigma_J;
  EXPECT_NEAR(sigma_J, 0.1 * robot.power.standby_W * plan.duration_s, 1e-6 * sigma_J);
  double sum_J = 0.0;
  for (const LegPlan& leg : plan.legs) sum_J += leg.energy_sigma_J.value();
  EXPECT_NEAR(sum_J, sigma_J, 1e-9 * sum_J);
  ASSERT_TRUE(plan.battery);
  const double drawn_J = plan.energy.total_J() + plan.battery->loss_J;
  EXPECT_NEAR(plan.battery->required_capacity_Wh * 3600, drawn_J, 1e-9 * drawn_J)
      << "a bound without the model's error is none";
  robot.uncertainty["model_energy"] = 0.06;
  const Plan bounded = plan_of(round_of_three(), kCoarse, robot);
  const double both_J = std::hypot(sigma_J, 0.06 * bounded.energy.motion_J());
  EXPECT_NEAR(bounded.energy_sigma_J.value(), both_J, 1e-6 * both_J);
  EXPECT_NEAR(bounded.battery->required_capacity_Wh * 3600, drawn_J + 1.6449 * both_J, 1e-4 * drawn_J)
      << "nineteen in twenty missions take less";
}

TEST(Route, AGoalOutsideOfTheMapIsToldAsThat) {
  MissionRequest mission = round_of_three();
  mission.stations["east"].x_m = 25.0;
  const Plan plan = plan_of(mission, kCoarse);
  ASSERT_TRUE(plan.infeasibility);
  EXPECT_EQ(plan.infeasibility->reason.constraint, "path");
  EXPECT_NE(plan.message.find("outside of the map"), std::string::npos) << plan.message;
  EXPECT_EQ(plan.message.find("swapped"), std::string::npos) << "the other order is outside, too";
}

TEST(Route, SwappedCoordinatesAreAskedForWhereTheyWouldBeOnTheMap) {
  MissionRequest mission = round_of_three();
  mission.stations["east"] = {
      .x_m = 6, .y_m = 20, .marks = {.path = "stations.east", .item = {"m.yaml", 4, 9}}};
  mission.legs = {{.to = "east", .marks = {.path = "legs[0]", .item = {"m.yaml", 7, 5}}}};
  const Plan plan =
      plan_mission(mission, {.robot = testing::nomad(), .map = free_grid(240, 120, 0.1)}, kCoarse);
  EXPECT_NE(plan.message.find("are x and y swapped?"), std::string::npos) << plan.message;
  EXPECT_NE(plan.message.find("m.yaml:4:9: stations.east"), std::string::npos) << plan.message;
}

/// The goal of one leg on a floor whose part beyond x = 12 m nobody has seen.
Plan plan_into_the_unknown(double x_m) {
  MissionRequest mission{.name = "unknown"};
  mission.stations = {{"goal", {.x_m = x_m, .y_m = 3}}};
  mission.start = {.pose = {2, 3, 0}};
  mission.legs = {{.to = "goal"}};
  OccupancyGrid map = floor_with_rack();
  for (std::size_t cell = 0; cell < map.cell_count(); ++cell)
    if (map.cell_at(cell).column >= 120) map.occupancy_percent[cell] = kUnknownCell;
  return plan_mission(mission, {.robot = testing::nomad(), .map = std::move(map)}, kCoarse);
}

TEST(Route, AGoalThatTheMapDoesNotKnowIsToldAsThat) {
  const Plan inside = plan_into_the_unknown(15), beside = plan_into_the_unknown(11.9);
  EXPECT_NE(inside.message.find("the goal (15.000, 3.000) m lies on an unknown cell of the map"),
            std::string::npos)
      << inside.message;
  EXPECT_NE(beside.message.find("to an unknown cell of the map at (12.000, 3.000) m"), std::string::npos)
      << beside.message;
  EXPECT_FALSE(plan_into_the_unknown(11.0).infeasibility);
}

}  // namespace
}  // namespace joulepath
